"""What is said of operations that a crash cut short, by what stands on the table; and what only a person can tell."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from benches import shel

from pico.diagnostics import ExitCode, PicoError
from pico.edge.recovery import open_questions, settle, verdict
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose
from pico.runs.journal import Journal

SETUP, _ = shel("gantry")
HERE, THERE = {"pose": {"x": 300, "y": 420, "yaw": 0}}, {"pose": {"x": 520, "y": 420, "yaw": 0}}
MOVE = Operation(
    id="op1", primitive="move", component="p1", robot="arm1", arguments={"from": HERE, "to": THERE},
    reason=Reason(kind="changed"),
)  # fmt: skip
SET = replace(MOVE, primitive="set", robot=None, arguments={"tunable": "angle", "to": 10.0})
GLUE = replace(MOVE, primitive="operator", robot=None, arguments={"text": "glue p1"})


def seen(**part: Any) -> Observation:
    return Observation(backend="sim", components={"p1": ObservedComponent(**part)})


@pytest.mark.parametrize(
    ("operation", "part", "outcome"),
    [
        (MOVE, {"pose": Pose(520.2, 420, 0.1)}, "done"),
        (MOVE, {"pose": Pose(522, 420, 0)}, "failed"),
        (MOVE, {"pose": Pose(300, 420, 0)}, "failed"),
        (MOVE, {"pose": Pose(520, 420, 0), "presence": "held"}, "failed"),
        (MOVE, {"presence": "missing"}, "unknown"),
        (SET, {"pose": Pose(0, 0), "values": {"angle": ObservedValue(value=10.0)}}, "done"),
        (SET, {"pose": Pose(0, 0), "values": {"angle": ObservedValue(value=11.0)}}, "failed"),
        (SET, {"pose": Pose(0, 0), "values": {"angle": ObservedValue(value=10.0, status="commanded")}}, "failed"),
        (GLUE, {"pose": Pose(520, 420, 0)}, "unknown"),
        (replace(MOVE, arguments={**MOVE.arguments, "irreversible": True}), {"pose": Pose(520, 420, 0)}, "unknown"),
    ],
)
def test_the_table_tells_how_an_operation_ended(operation: Operation, part: dict[str, Any], outcome: str) -> None:
    assert verdict(SETUP, operation, seen(**part)) == outcome


def begun(path: Path, *operations: Operation) -> Journal:
    journal = Journal(path / "journal.sqlite")
    for number, op in enumerate(operations):
        journal.intend(f"r1/op{number}/1", op, token=1)
        journal.started(f"r1/op{number}/1", None, token=1)
    return journal


def test_what_began_is_settled_once_and_a_later_look_settles_what_was_not_seen(tmp_path: Path) -> None:
    journal = begun(tmp_path, MOVE)
    assert [s.outcome for s in settle(SETUP, journal, seen(presence="missing"), 2)] == ["unknown"]
    assert [s.outcome for s in settle(SETUP, journal, seen(pose=Pose(520, 420, 0)), 3)] == ["done"]
    assert settle(SETUP, journal, seen(pose=Pose(520, 420, 0)), 4) == ()
    assert [r.kind for r in journal.records()] == ["intent", "started", "unknown", "resolved"]
    result = journal.intend("r1/op0/1", MOVE, token=4)
    assert result is not None
    assert result.outcome == "done"


def test_only_a_person_tells_of_a_step_by_hand(tmp_path: Path) -> None:
    journal = begun(tmp_path, GLUE)
    settle(SETUP, journal, seen(pose=Pose(520, 420, 0)), 2)
    (question,) = open_questions(journal.unsettled())
    assert "glue p1" in question.summary
    assert "pico recover --done r1/op0/1" in question.hint
    settle(SETUP, journal, seen(pose=Pose(520, 420, 0)), 3)
    assert open_questions(journal.unsettled()) == [question]
    journal.resolve("r1/op0/1", "done", "ann", None, 4)
    assert journal.unsettled() == ()
    assert journal.records()[-1].data == {"outcome": "done", "by": "ann"}


def test_who_comes_late_writes_nothing(tmp_path: Path) -> None:
    journal = begun(tmp_path)
    journal.fence(7)
    with pytest.raises(PicoError) as caught:
        journal.intend("r2/op1/1", MOVE, token=6)
    assert caught.value.exit_code == ExitCode.LOCKED
    with pytest.raises(PicoError):
        journal.fence(6)
    assert journal.records() == ()


def test_the_last_pick_of_a_hand_is_where_it_took_the_part_not_where_a_set_down_began(tmp_path: Path) -> None:
    held = replace(MOVE, arguments={"from": {**THERE, "held": True}, "to": HERE})
    journal = begun(tmp_path, MOVE, held)
    pick = journal.last_pick("arm1")
    assert pick is not None
    assert pick.arguments["from"] == HERE
    assert journal.last_pick("arm2") is None


def test_a_hand_that_only_tells_its_width_holds_what_it_picked_last(tmp_path: Path) -> None:
    from pico.edge.grip import with_picks

    journal = begun(tmp_path, MOVE)
    grasp = SETUP.type_of("p1").geometry.grasp
    assert grasp is not None
    for opening, holding in ((grasp.width, "p1"), (grasp.width + 20, None), (None, None)):
        hand = ObservedRobot(joints=(), opening=opening)
        found = with_picks(SETUP, journal, Observation(backend="sim", robots={"arm1": hand})).robots["arm1"]
        assert (found.holding, found.picked) == (holding, Pose(300, 420, 0) if holding else None)


def test_a_journal_of_an_earlier_version_is_taken_over(tmp_path: Path) -> None:
    import sqlite3

    with sqlite3.connect(tmp_path / "journal.sqlite") as db:
        db.executescript(
            "CREATE TABLE runs (run TEXT PRIMARY KEY, plan TEXT NOT NULL, holder TEXT NOT NULL, started_at TEXT NOT"
            " NULL, finished_at TEXT, outcome TEXT, tally TEXT) WITHOUT ROWID;"
            "CREATE TABLE records (seq INTEGER PRIMARY KEY AUTOINCREMENT, key TEXT NOT NULL, run TEXT NOT NULL, phase"
            " INTEGER NOT NULL, kind TEXT NOT NULL, component TEXT NOT NULL, digest TEXT NOT NULL, token INTEGER NOT"
            " NULL, at TEXT NOT NULL, data TEXT NOT NULL, UNIQUE (key, phase));"
            "INSERT INTO runs VALUES ('b', 'p', 'ann', '2026-02', NULL, NULL, NULL), ('a', 'p', 'ann', '2026-03',"
            " '2026-03', 'done', '{}'); PRAGMA user_version=1;"
        )
    journal = Journal(tmp_path / "journal.sqlite")
    assert [(r.run, r.outcome) for r in journal.runs()] == [("b", None), ("a", "done")]
    assert journal.document("a") is None
