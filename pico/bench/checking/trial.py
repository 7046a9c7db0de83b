"""A throw-away simulated bench: brought to a state, planned from there, and really moved. Touches no bench's own
world, journal or lock."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pico.backends.sim.world import World, new_world, observe
from pico.model.lab import Setup
from pico.model.observation import Observation, ObservedValue, live_state
from pico.model.operation import Operation
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.report import RunReport
from pico.model.state import LabState, place_of
from pico.motion.deferred import DeferredMotion
from pico.planning import plan
from pico.planning.checks.target import Source

CALIBRATION = "calibration.json"


def simulated(setup: Setup) -> Setup:
    """Return the bench as a trial has it: nothing goes wrong at random, where parts are is known exactly, and the rules
    of the lab are asked apart from it."""
    sim = replace(setup.lab.sim, observe="exact", faults={})
    policy = replace(setup.lab.policy, rules=())
    return replace(setup, lab=replace(setup.lab, sim=sim, policy=policy))


def world_of(setup: Setup, state: LabState) -> World:
    """Return a simulated world in a state that names every part of the inventory."""
    world = new_world(setup)
    for name, body in world.components.items():
        part = state.components.get(name)
        said = {k: v for k, v in part.values.items() if k in body.values} if part else {}
        values = {**body.values, **{k: ObservedValue(value=v) for k, v in said.items()}}
        world = world.with_body(name, pose=place_of(setup, state, name)[1], values=values)
    return world


def seen_in(world: World) -> Observation:
    """Return what there is to see of a world."""
    return observe(world, "sim", "")


def plan_from(
    setup: Setup, world: World, wanted: LabState, *, base: str | None, name: str, fidelity: str, source: Source
) -> Plan:
    """Return the plan from a world to the state `wanted`, which is called `name`; `base`: the commit of the world."""
    seen = seen_in(world)
    return plan(
        setup,
        seen,
        wanted,
        motion=DeferredMotion(setup),
        backend="sim",
        fidelity=fidelity,
        base=Base(commit=base, state=live_state(setup, seen).as_json()),
        target=Target(title=name, state=wanted.as_json(), expect=wanted.expect or None),
        source=source,
    )


def by_hand(plan: Plan) -> tuple[Operation, ...]:
    """Return what a person has to do in a plan."""
    return tuple(op for op in plan.operations if op.kind.by_hand)


def after_hands(world: World, operations: tuple[Operation, ...]) -> World:
    """Return the world in which a person has done these operations."""
    for op in operations:
        goal, tunable = op.arguments.get("to"), op.arguments.get("tunable")
        if tunable:
            world = world.with_value(op.component, str(tunable), ObservedValue(value=goal))
        elif isinstance(goal, Mapping):
            world = world.with_body(op.component, pose=Pose(**goal["pose"]))
    return world


def run(setup: Setup, world: World, plan: Plan, *, fidelity: str, lab: Path) -> RunReport:
    """Run a plan in a world of its own in a temporary folder, with the calibration of the folder `lab`, and return what
    became of it; raises PicoError where the simulator refuses the plan."""
    from pico.backends.sim.backend import SimBackend
    from pico.backends.sim.store import save_world
    from pico.execution.async_execution import AsyncExecution
    from pico.execution.blocking import Execution, LoopThread

    own = simulated(setup)
    plan = replace(plan, fidelity=fidelity, lab=LabRef(name=plan.lab.name, digest=own.digest()))
    thread = LoopThread()
    with tempfile.TemporaryDirectory(prefix="pico-check-") as name:
        folder = Path(name)
        if (lab / CALIBRATION).is_file() and not (lab / CALIBRATION).is_symlink():
            shutil.copy(lab / CALIBRATION, folder)
        save_world(folder, world, durable=False)
        backend = SimBackend(own, folder, fidelity)
        try:
            execution = Execution(AsyncExecution(own, plan, backend, holder="pico check"), thread)
            for _ in execution:
                pass
            return execution.report
        finally:
            thread.wait(backend.close())
            thread.close()
