"""A throw-away simulated bench: brought to a state, planned from there, and really moved. Touches no bench's own
world, journal or lock."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.devices import SIMULATOR
from pico.model.observation import Observation, ObservedValue
from pico.model.operation import Operation
from pico.model.plan import LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.trace.report import RunReport
from pico.motion.deferred import DeferredMotion
from pico.places.bench import BenchPlace
from pico.planning import PlanGoal, Planner
from pico.planning.checks.target import Source
from pico.vision.calibration_files import read_from

if TYPE_CHECKING:
    from pico.bench.running.loop import LoopThread
    from pico.edge.contract import Edge


def simulated(setup: Setup) -> Setup:
    """Return the bench as a trial has it: nothing goes wrong at random, where parts are is known exactly, and the rules
    of the lab are asked apart from it."""
    sim = replace(setup.lab.sim, observe="exact", faults={})
    policy = replace(setup.lab.policy, rules=())
    return replace(setup, lab=replace(setup.lab, sim=sim, policy=policy))


def stood_as(setup: Setup, state: LabState) -> Observation:
    """Return a simulated bench as observed that stands as a state says which names every part of the inventory."""
    with _bench(setup) as (edge, thread):
        seen = thread.wait(edge.observe())
    for name, part in seen.components.items():
        wanted = state.components.get(name)
        said = {k: v for k, v in wanted.values.items() if k in part.values} if wanted else {}
        values = {**part.values, **{k: ObservedValue(value=v) for k, v in said.items()}}
        seen = _with(seen, name, pose=place_of(setup, state, name)[1], values=values)
    return seen


def _with(seen: Observation, name: str, **changes: Any) -> Observation:
    return replace(seen, components={**seen.components, name: replace(seen.components[name], **changes)})


def plan_from(
    setup: Setup, seen: Observation, wanted: LabState, *, base: str | None, name: str, fidelity: str, source: Source
) -> Plan:
    """Return the plan from a bench to the state `wanted`, which is called `name`; `base`: the commit of the bench."""
    planner = Planner(setup, DeferredMotion(setup), seen, SIMULATOR, fidelity, base)
    return planner.plan(PlanGoal(wanted, Target(title=name, expect=wanted.expect or None), source=source))


def by_hand(plan: Plan) -> tuple[Operation, ...]:
    """Return what a person has to do in a plan."""
    return tuple(op for op in plan.operations if op.kind.by_hand)


def after_hands(seen: Observation, operations: tuple[Operation, ...]) -> Observation:
    """Return the bench in which a person has done these operations."""
    for op in operations:
        goal, tunable = op.arguments.get("to"), op.arguments.get("tunable")
        if tunable:
            values = {**seen.components[op.component].values, str(tunable): ObservedValue(value=goal)}
            seen = _with(seen, op.component, values=values)
        elif isinstance(goal, Mapping):
            seen = _with(seen, op.component, pose=Pose(**goal["pose"]))
    return seen


def run(setup: Setup, seen: Observation, plan: Plan, *, fidelity: str, lab: Path) -> RunReport:
    """Run a plan on a simulated bench of its own that stands as `seen`, with the calibration of the folder `lab`, and
    return what became of it; raises PicoError where the simulator refuses the plan."""
    from pico.bench.running.execution import Execution

    plan = replace(plan, fidelity=fidelity, lab=LabRef(name=plan.lab.name, digest=simulated(setup).digest()))
    with _bench(setup, fidelity, lab) as (edge, thread):
        edge.world.put(seen)
        execution = Execution(plan, edge, thread, holder="pico check")
        for _ in execution:
            pass
        return execution.report


@contextmanager
def _bench(setup: Setup, fidelity: str = "kinematic", lab: Path | None = None) -> Iterator[tuple[Edge, LoopThread]]:
    """Give a simulated bench in a temporary folder, with every part at home, and the thread that it lives in."""
    from pico.bench.running.loop import LoopThread
    from pico.edge.local import embedded

    thread = LoopThread()
    with tempfile.TemporaryDirectory(prefix="pico-check-") as name:
        folder = Path(name)
        found = read_from(lab, SIMULATOR) if lab is not None else None
        if lab is not None and found is not None and found.is_file() and not found.is_symlink():
            copy = folder / found.relative_to(lab)
            copy.parent.mkdir(exist_ok=True)
            shutil.copy(found, copy)
        edge = embedded(simulated(setup), BenchPlace(folder, SIMULATOR), fidelity)
        try:
            yield edge, thread
        finally:
            thread.wait(edge.close())
            thread.close()
