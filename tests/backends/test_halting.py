"""A halted arm ends its move where that is sooner; a stopped one brakes, holds, and shuts the beam."""

from __future__ import annotations

import asyncio
import random
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from benches import execute, plan_to, run, shel, sim
from oracles.unfinished import unfinished
from results import RunResult

from pico.backends.halting import sooner, way_out
from pico.backends.sim.fault_effects import strikes
from pico.backends.sim.faults import Fault
from pico.backends.sim.store import load_world
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.motion.types import MovePath, Segment, Stage

SETUP, C3 = shel("gantry")
START = Pose(110, 220, 0)


def path(*names: Any) -> MovePath:
    return MovePath("arm1", "p1", tuple(Segment(n, (0.0, 1.0), ((0.0,), (0.0,)), 10.0) for n in names))


def test_what_a_halted_arm_may_do_depends_on_whether_it_holds_the_part() -> None:
    whole = path("approach", "descend", "grip", "lift", "transit", "lower", "release", "retreat")
    ways = [way_out(whole, Stage(segment.name, 0.5)) for segment in whole.segments]
    assert ways == ["leaves_it", "leaves_it", "undecided", "may_turn_back", "may_turn_back", *["goes_on"] * 3]
    assert way_out(path("park"), Stage("park")) == "goes_on"
    assert way_out(path("lift", "transit", "lower", "release", "retreat"), Stage("lift")) == "goes_on"


def test_what_is_left_of_a_way_and_when_a_part_drops_is_told_by_what_the_arm_executes() -> None:
    whole = path("approach", "descend", "grip", "lift", "transit", "lower", "release", "retreat")
    assert whole.gone(Stage("transit", 0.25)) == 4.25 and whole.gone(Stage("park", 0.5)) == 8.0
    assert sooner(whole, Stage("lift", 0.5), path("lower", "retreat"))
    assert not sooner(whole, Stage("retreat", 0.1), path("lower"))
    drop = Fault("drop", random.Random(1))
    assert not strikes(drop, Stage("lift", 1.0)) and not strikes(drop, Stage("transit", drop.at - 0.01))
    assert strikes(drop, Stage("transit", drop.at)) and strikes(drop, Stage("lower"))
    assert not strikes(Fault("camera", random.Random(1)), Stage("lower"))


def cut_short(root: Path, phase: str, how: str, share: float = 0.0) -> RunResult:
    """Run to C3, and halt or stop in a phase of the move of p1."""
    bench = sim(SETUP, root)

    async def go() -> RunResult:
        planned, events, acted = await plan_to(bench, C3), [], False
        async for event in run(planned, bench, run_id="r1"):
            events.append(event)
            there = event.component == "p1" and event.data.get("phase") == phase
            if there and event.data["fraction"] >= share and not acted:
                acted = True
                await getattr(bench, how)()
        return RunResult.of(events)

    return asyncio.run(go())


@pytest.mark.parametrize(("phase", "goes_back"), [("approach", True), ("lift", True), ("lower", False)])
def test_a_part_goes_to_its_goal_or_back_and_the_hand_is_empty(tmp_path: Path, phase: str, goes_back: bool) -> None:
    result = cut_short(tmp_path, phase, "halt")
    world, _ = load_world(SETUP, bench_at(tmp_path))
    pose = world.components["p1"].pose
    assert pose is not None
    assert world.robots["arm1"].holding is None
    assert (pose.distance(START) < 1e-6) == goes_back
    assert result.outcome == "interrupted"
    notes = [r.data["diagnostic"] for r in result.operations.values() if r.outcome == "failed"]
    assert [n["code"] for n in notes] == (["put-back"] if goes_back else [])
    bench = sim(SETUP, tmp_path)
    again, _ = asyncio.run(execute(bench, asyncio.run(plan_to(bench, C3)), "r2"))
    assert again.outcome == "done"


def test_stopped_the_shutter_is_closed_the_part_held_and_the_journal_whole(tmp_path: Path) -> None:
    cut_short(tmp_path, "transit", "stop", share=0.4)
    world, _ = load_world(SETUP, bench_at(tmp_path))
    assert world.robots["arm1"].holding == "p1"
    assert world.components["laser"].values["shutter"].value == "closed"
    bench = sim(SETUP, tmp_path)
    assert unfinished(bench.journal) == ()
    planned = asyncio.run(plan_to(bench, C3))
    first = next(op for op in planned.operations if op.robot)
    assert first.reason.kind == "held"
    assert slot_at(SETUP, Pose(**first.arguments["to"]["pose"])) == "storage/b1"
    assert asyncio.run(execute(bench, planned, "r2"))[0].outcome == "done"
