"""Runs in the physical world: what is placed is right within tolerance, what is dropped is said and left true."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from benches import apply, changed, plan_to, shel, sim

from pico.model.diff import diff_observed
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.model.trace.event import Event

SETUP, C3 = shel()
BEFORE = changed(C3, {"p2": {"pose": Pose(520, 420, 30)}, "lx_100": {"pose": Pose(420, 420)}})


def test_parts_carried_by_friction_end_within_tolerance_the_same_each_time(tmp_path: Path) -> None:
    told = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        apply(sim(SETUP, folder), BEFORE, "r0")
        bench = sim(SETUP, folder, fidelity="physics")
        planned, result, events = apply(bench, C3)
        assert result.outcome == "done" and abs(result.seconds / planned.makespan - 1) < 0.03
        seen = asyncio.run(bench.observe())
        assert [c.text for c in diff_observed(SETUP, seen, C3) if not c.tolerated] == []
        p2, lens = seen.components["p2"].pose, seen.components["lx_100"].pose
        assert p2 is not None
        assert lens is not None
        assert 0 < p2.distance(Pose(520, 420)) < 0.5  # physics: near, and never exact
        assert slot_at(SETUP, lens) == "storage/a1"
        told.append((events, seen))
    assert told[0] == told[1]
    assert all_phases(told[0][0], {"p2": Pose(520, 420), "lx_100": lens}) == {"lift", "transit", "lower"}


def all_phases(events: Sequence[Event], goals: dict[str, Pose]) -> set[str]:
    """The phases that were told while a part was held; each is what the arm did at that moment."""
    phases = set()
    for event in events:
        phase = event.data.get("phase")
        if phase in ("approach", "descend", "retreat", "park"):
            assert "pose" not in event.data
        elif phase in ("lift", "transit", "lower"):
            phases.add(phase)
            part = Pose(**event.data["pose"])
            assert phase != "lower" or event.component not in goals or part.distance(goals[event.component]) < 5
    return phases


def test_without_friction_every_part_is_dropped_and_the_table_is_told_as_it_is(tmp_path: Path) -> None:
    sim_settings = replace(SETUP.lab.sim, pad_friction=0.0, sight="exact")
    slippery = replace(SETUP, lab=replace(SETUP.lab, sim=sim_settings))
    apply(sim(slippery, tmp_path), BEFORE, "r0")
    bench = sim(slippery, tmp_path, fidelity="physics")
    planned, result, _ = apply(bench, C3)
    lost = [op for op in planned.operations if op.primitive in ("move", "stow")]
    assert (result.outcome, result.failed, result.skipped) == ("failed", len(lost), 1)  # the shutter stays closed
    for op in lost:
        assert f"dropped {op.component}" in result.operations[op.id].data["diagnostic"]["summary"]
    seen = asyncio.run(bench.observe())
    assert seen.robots["arm1"].holding is None
    pose = seen.components["p2"].pose
    assert pose is not None
    assert pose.distance(Pose(520, 420)) < 5
    again = asyncio.run(plan_to(bench, C3))
    assert {op.component for op in again.operations if op.primitive != "park"} == {
        "laser", *(op.component for op in lost)
    }  # fmt: skip
