"""The bench of the case study for tests, with its arm or, quicker, with a gantry; plans and runs on it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from results import RunResult

from pico.backends.sim.device import SimDevice
from pico.edge.contract import Edge
from pico.edge.local import LocalEdge
from pico.edge.protocol import Job
from pico.manifest.load import load_folder
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.model.trace.event import Event
from pico.motion.arms import ArmMotion
from pico.places.bench import BenchPlace
from pico.planning import PlanGoal, Planner

SHEL = Path(__file__).resolve().parent.parent.parent / "labs" / "shel"
NOON = "2026-11-01T12:00:00Z"


def shel(model: str = "xarm7") -> tuple[Setup, LabState]:
    """Return the bench and its state C3."""
    setup, state = load_folder(SHEL).require()
    robots = {name: replace(robot, model=model) for name, robot in setup.lab.robots.items()}
    return replace(setup, lab=replace(setup.lab, robots=robots)), state


def changed(state: LabState, components: Mapping[str, Mapping[str, Any]]) -> LabState:
    """Return the state with fields of some components replaced; `values` are added to those that are there."""
    parts = dict(state.components)
    for name, fields in components.items():
        old = parts.get(name, ComponentState())
        values = {**old.values, **fields.get("values", {})}
        place = {k: v for k, v in fields.items() if k in ("slot", "pose")}
        if place:
            old = replace(old, slot=None, pose=None)
        parts[name] = replace(old, **place, values=values)
    return replace(state, components=parts)


def sim(setup: Setup, root: Path, **options: Any) -> LocalEdge:
    """Return the simulated bench in folder `root`, at noon."""
    clock = options.pop("clock", lambda: NOON)
    given = {"fidelity": "kinematic", "clock": clock} | options
    return LocalEdge(
        setup, BenchPlace(root, "sim"), lambda setup: SimDevice(setup, BenchPlace(root, "sim"), **given), clock=clock
    )


async def plan_to(backend: LocalEdge, wanted: LabState) -> Plan:
    """Return the plan from the bench as it stands to `wanted`."""
    setup, seen = backend.setup, await backend.observe()
    able = await backend.describe()
    return Planner(setup, ArmMotion(setup), seen, able.name, able.fidelity).plan(PlanGoal(wanted))


async def execute(
    backend: LocalEdge, planned: Plan, run_id: str = "r1", cancelled: Callable[[], bool] = lambda: False
) -> tuple[RunResult, list[Event]]:
    """Run a plan to its end."""
    events = [e async for e in run(planned, backend, run_id=run_id, cancelled=cancelled)]
    return RunResult.of(events), events


async def run(
    planned: Plan, edge: Edge, *, run_id: str, cancelled: Callable[[], bool] = lambda: False, **options: Any
) -> AsyncGenerator[Event, None]:
    """Run a plan under an id and yield its events; once `cancelled()`, it is cancelled."""
    await edge.start(Job(plan=planned, holder="test", **options), run_id)
    async for event in edge.events(run_id):
        yield event
        if cancelled():
            await edge.cancel(run_id)
    await edge.report(run_id)


def apply(backend: LocalEdge, wanted: LabState, run_id: str = "r1") -> tuple[Plan, RunResult, list[Event]]:
    """Plan to a state and run that."""

    async def both() -> tuple[Plan, RunResult, list[Event]]:
        planned = await plan_to(backend, wanted)
        assert not planned.errored, [d.summary for d in planned.diagnostics]
        return planned, *(await execute(backend, planned, run_id))

    return asyncio.run(both())
