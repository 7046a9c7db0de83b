"""Real processes, really killed, around every record and at any instant: nothing is lost and nothing done twice."""

from __future__ import annotations

from pathlib import Path

from killing import kill_many


def test_killed_at_any_instant_nothing_is_lost_nothing_repeated_and_the_goal_is_reached(tmp_path: Path) -> None:
    score = kill_many(tmp_path, first=1, kills=40)
    wrong = tmp_path / "wrong.txt"
    assert score.wrong == 0, wrong.read_text() if wrong.exists() else score
    assert score.checked >= 4
