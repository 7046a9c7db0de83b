"""Random rearrangements: every plan passes the checker, and nothing solvable is refused."""

from __future__ import annotations

import pytest
from fuzzing import SMALL, Verdict, judge


def judged(seeds: range, most: int = 30) -> list[Verdict]:
    verdicts = [judge(seed, most=most) for seed in seeds]
    wrong = [(v.seed, f) for v in verdicts for f in v.wrong]
    assert wrong == []
    return verdicts


def test_random_rearrangements_are_planned_without_a_fault() -> None:
    verdicts = judged(range(8))
    assert sum(v.staged > 0 for v in verdicts) > 2, "the cases are too easy to mean anything"
    assert sum(bool(v.refused) for v in verdicts if v.components > SMALL) <= 1


def test_nothing_solvable_is_refused_on_a_small_table() -> None:
    verdicts = judged(range(5000, 5016), most=SMALL)
    assert any(v.refused for v in verdicts), "without a refusal there is nothing to decide"


@pytest.mark.slow
def test_a_thousand_random_rearrangements() -> None:
    verdicts = judged(range(1000))
    large = [v for v in verdicts if v.components > SMALL]
    assert not any(v.undecided for v in verdicts)
    assert sum(bool(v.refused) for v in large) <= 0.05 * len(large)
