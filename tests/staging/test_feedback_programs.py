"""The program over known cycles: what its relaxation proves, and how its work is counted."""

from __future__ import annotations

from itertools import combinations

from pico.staging.feedback.clauses import SMALL, Cover
from pico.staging.feedback.limit import WorkLeft


def _pairs(count: int) -> Cover:
    """Return the program of which each pair of variables wants one: all but one are chosen then."""
    cover = Cover([1.0] * count)
    for pair in combinations(range(count), 2):
        cover.one_of(pair)
    return cover


def test_a_relaxation_proves_a_cost_rounded_up_to_a_whole_one() -> None:
    share, least = _pairs(5).relaxed()
    assert share == (0.5,) * 5 and least == 3.0


def test_a_relaxation_without_any_choice_proves_nothing() -> None:
    cover = Cover([1.0, 1.0])
    cover.exactly_one([0])
    cover.exactly_one([1])
    cover.exactly_one([0, 1])
    assert cover.relaxed() == ((), 0.0)


def test_a_node_of_a_large_program_counts_as_many() -> None:
    spent = {}
    for count in (40, 100):
        cover, work = _pairs(count), WorkLeft(10, 10_000)
        assert len(cover.solve(work).chosen or ()) == count - 1
        spent[count] = 10_000 - work.nodes
    entries = 100 * 99
    each = (entries // SMALL) ** 2
    assert spent[40] <= 1 and spent[100] >= each and spent[100] % each == 0
