"""What a twin may learn from is read from traces: placements and their tries, times, looks at what nothing moved."""

from __future__ import annotations

from typing import Any

import pytest
from run_documents import run_document

from pico.manifest.load import load_folder
from pico.model.trace.run import TraceEvent
from pico.resources import labs_dir
from pico.runs.document import RecordedRun
from pico.runs.learning import looks_of
from pico.runs.lessons import Lessons, lessons
from pico.runs.trace import numbered

SETUP, _ = load_folder(labs_dir() / "minimal").require()
GOAL = {"pose": {"x": 500.0, "y": 420.0, "yaw": 179.9}}
MEANT = {"primitive": "move", "robot": "arm1", "arguments": {"to": GOAL}, "seconds": 8.0, "reason": {"kind": "asked"}}


def at(x: float, y: float = 420.0, yaw: float = 179.9, how: str = "stereo", **more: Any) -> dict[str, Any]:
    sigma = {"position": 0.04, "yaw": 0.02}
    pose = {"x": x, "y": y, "yaw": yaw}
    return {"presence": "seen", "pose": pose, "uncertainty": sigma, "age": 0, "values": {}, "how": how} | more


def told(*events: tuple[str, dict[str, Any]], seen: tuple[dict[str, Any], ...] = ()) -> Lessons:
    """Return what a run tells in which the lens was moved, or looked at by itself (`seen`) at its end."""
    trace = [TraceEvent(t=0, seq=1, kind=kind, operation="op1", attempt=1, component="lens", data=data)
             for kind, data in events]  # fmt: skip
    looks = [TraceEvent(t=9, seq=1, kind="observation", component="lens", data=data) for data in seen]
    run = RecordedRun(document=run_document(), trace=numbered(trace), measurements=numbered(looks))
    return lessons(SETUP, [run])


def ended(after: dict[str, Any], kind: str = "done", **more: Any) -> tuple[tuple[str, dict[str, Any]], ...]:
    return ("intent", MEANT), ("started", {"before": at(300.0)}), (kind, {"seconds": 9.0, "after": after, **more})


def test_a_placement_is_off_by_what_was_seen_against_its_goal_and_takes_what_it_took() -> None:
    found = told(*ended(at(500.3, 419.9, -179.9)))
    (off,) = found.placed
    assert (off.x, off.y, off.yaw) == pytest.approx((0.3, -0.1, 0.2))
    assert (off.position, off.turn) == (0.04, 0.02)
    assert found.times == {"move arm1": [(9.0, 8.0)]}


def test_a_part_that_was_set_right_was_placed_twice_and_its_time_is_not_the_plans() -> None:
    found = told(*ended(at(500.1), data={"stood": [{"x": 501.0, "y": 420.0, "yaw": 179.9}]}))
    assert [off.x for off in found.placed] == pytest.approx([1.0, 0.1]) and not found.times


def test_one_that_missed_counts_and_one_that_was_lost_does_not() -> None:
    assert len(told(*ended(at(501.0), "failed", error={"code": "misplaced"})).placed) == 1
    assert not told(*ended(at(501.0), "failed", error={"code": "dropped"})).placed
    assert not told(*ended(at(501.0, how="placed"))).placed
    assert not told(*ended(at(501.0, presence="toppled"))).placed


def test_looks_at_what_nothing_moved_differ_by_their_noise() -> None:
    found = told(*ended(at(500.0)), seen=(at(500.03), at(500.03), at(499.98, how="remembered"), at(500.01)))
    assert [off.x for off in found.looked["lens"]] == pytest.approx([0.03, -0.02])
    assert found.stood["lens"].x == 500.01


def test_a_move_is_no_noise_nor_is_what_a_simulator_knows_exactly() -> None:
    assert not told(*ended(at(500.0))).looked
    assert not told(*ended(at(500.0, how="")), seen=(at(500.1, how=""), at(500.2, how=""))).looked


def test_many_looks_tell_how_looks_scatter() -> None:
    offs = (0.03, -0.03) * 8
    found = looks_of(told(seen=tuple(at(500.0 + off, 420.0 - off, 10 * off) for off in offs)))
    assert found is not None and found.position is not None and found.yaw is not None
    assert found.position.value == pytest.approx(0.06 / 2**0.5) and found.position.count == 30
    assert looks_of(told(seen=tuple(at(500.0 + off) for off in offs[:5]))) is None
