"""Runs that are cut off at any point: nothing is repeated, nothing is told that is not so, and the goal is reached."""

from __future__ import annotations

import pytest
from crashing import histories


@pytest.mark.parametrize("count", [60, pytest.param(250, marks=pytest.mark.slow)])
def test_whatever_is_cut_off_the_invariants_hold_and_the_goal_is_reached(count: int) -> None:
    crashes = 0
    for seed, found in histories(0, count):
        assert not isinstance(found, Exception), f"seed {seed}: {found}"
        crashes += found.crashes
    assert crashes > 2 * count


def test_the_same_seed_is_the_same_history() -> None:
    counts = [[(c.crashes, c.points) for _, c in histories(7, 5) if not isinstance(c, Exception)] for _ in range(2)]
    assert counts[0] == counts[1]
    assert len(counts[0]) == 5
