"""The case study with its real arm: every state of its history is reached, in any order, and then nothing is left."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from benches import apply, changed, plan_to, shel, sim

from pico.model.diff import diff_observed
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.model.state import LabState, place_of
from pico.runs.journal import Journal

TILTED = {"p2": {"pose": Pose(520, 420, 30)}, "p1": {"values": {"angle": 1.0}}}


def lens(name: str, x: float) -> dict[str, dict[str, Pose]]:
    return {name: {"pose": Pose(x, 420)}}


def history() -> dict[str, LabState]:
    _, c3 = shel()
    c2 = changed(c3, {"p2": {"slot": "storage/b2"}})
    e11, e21 = changed(c3, lens("lx_125", 395)), changed(c3, lens("lx_100", 420))
    e12, e22, e31 = (
        changed(e11, lens("ly_150", 670)),
        changed(e21, lens("ly_150", 670)),
        changed(e21, lens("ly_200", 720)),
    )
    return {
        "C1": changed(c2, {"p1": {"slot": "storage/b1"}}), "C2": c2, "C3": c3,
        "E1-1": e11, "E1-2": e12, "E1-3": changed(e12, TILTED),
        "E2-1": e21, "E2-2": e22, "E2-3": changed(e22, TILTED),
        "E3-1": e31, "E3-2": changed(e31, TILTED),
    }  # fmt: skip


WAY = ("C1", "C2", "C3", "E1-1", "E1-2", "E1-3", "E2-3", "E2-1", "E2-2", "E3-1", "E3-2", "E1-1", "C1")


def test_every_state_is_reached_from_the_one_before_and_predicted_times_hold(tmp_path: Path) -> None:
    states, (setup, _) = history(), shel()
    for step, name in enumerate(WAY):
        backend = sim(setup, tmp_path)  # a new one each time, as a new command has
        planned, result, _ = apply(backend, states[name], f"r{step}")
        assert result.outcome == "done", (name, result)
        assert result.seconds == pytest.approx(planned.makespan, abs=1e-3), name
        seen = asyncio.run(backend.observe())
        assert [c.text for c in diff_observed(setup, seen, states[name], exact=True)] == [], name
        for part in setup.lab.inventory:
            slot, goal = place_of(setup, states[name], part)
            pose = seen.components[part].pose
            assert pose is not None
            assert slot_at(setup, pose) == slot if slot else pose.distance(goal) < 1e-9, (name, part)
        assert asyncio.run(plan_to(backend, states[name])).operations == ()
    assert {r.outcome for r in Journal(tmp_path / ".pico/benches/sim" / "journal.sqlite").runs()} == {"done"}


def test_the_same_seed_gives_the_same_events_journal_and_table(tmp_path: Path) -> None:
    states, (setup, _) = history(), shel()
    told = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        backend = sim(setup, folder)
        _, _, events = apply(backend, states["E2-3"], "r1")
        journal = [(r.key, r.kind, r.digest, r.at, r.data) for r in backend.journal.records()]
        told.append((events, journal, (folder / ".pico/benches/sim" / "world.json").read_bytes()))
    assert told[0] == told[1]
    assert sum(e.kind == "operation_progress" for e in told[0][0]) > 30


def test_motors_turn_while_the_arm_moves(tmp_path: Path) -> None:
    setup, _ = shel()
    planned, result, events = apply(sim(setup, tmp_path), history()["C3"])
    took = sum(r.data["seconds"] for r in result.operations.values())
    arm = sum(r.data["seconds"] for r in result.operations.values() if "error_mm" in r.data)
    assert result.seconds < took - 5
    park = next(op.id for op in planned.operations if op.primitive == "park")
    opens = 0.05  # the shutter of a new table's laser is closed; it opens when the arm is parked
    assert result.seconds == pytest.approx(arm + result.operations[park].data["seconds"] + opens)
    started = [e.operation for e in events if e.kind == "operation_started" and e.time == 0.0]
    assert started == ["op1", "op2", "op3", "op4", "op5"]
    assert [op.id for op in planned.operations if op.robot and op.id in started] == ["op1"]
