"""Whose connection is closed: who is late, and who leaves when there are too many."""

from __future__ import annotations

from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.server.guard.visits import HEADERS, RATE, STRANGERS, Phase, Visit, superfluous

PHASES = get_args(Phase)
VISITS = st.builds(
    Visit, st.sampled_from(["a", "b", "c"]), st.floats(0, 100), st.sampled_from(PHASES), st.booleans(), st.just(0)
)  # fmt: skip


@pytest.mark.parametrize(("phase", "after", "received", "late"), [
    ("headers", HEADERS, 0, False), ("headers", HEADERS + 0.1, 0, True), ("headers", HEADERS + 0.1, 60_000, True),
    ("body", HEADERS + 0.1, 0, True), ("body", HEADERS + 0.1, RATE, False), ("body", HEADERS + 1.1, RATE, True),
    ("idle", 1e6, 0, False), ("answering", 1e6, 0, False),
])  # fmt: skip
@pytest.mark.parametrize("known", [False, True])
def test_headers_and_bodies_have_a_time(phase: Phase, after: float, received: int, late: bool, known: bool) -> None:
    assert Visit("a", 50.0, phase, known, received).late(50.0 + after) is late


def test_a_phase_begins_once_and_counts_its_own_bytes() -> None:
    visit = Visit("a", 0.0, received=7)
    visit.enter("headers", 9.0)
    assert (visit.since, visit.received) == (0.0, 7)
    visit.enter("body", 9.0)
    assert (visit.since, visit.received) == (9.0, 0)


@given(st.lists(VISITS, max_size=12), st.sampled_from(["a", "b"]), st.integers(0, 12), st.integers(0, 4))
def test_one_leaves_exactly_if_there_are_too_many(
    present: list[Visit], address: str, room: int, strangers: int
) -> None:
    found = superfluous(present, address, room, strangers)
    same = [v for v in present if v.address == address and not v.known]
    may_leave = [v for v in present if not v.known or v.phase != "answering"]
    if len(same) > strangers:
        assert found in same
        assert all(PHASES.index(found.phase) >= 0 and found.since <= v.since for v in same if v.phase == found.phase)
    elif len(present) > room and may_leave:
        assert found in may_leave
        assert not found.known or all(v.known for v in may_leave), "strangers leave first"
    else:
        assert found is None


def test_who_waits_with_half_a_header_leaves_before_who_is_answered() -> None:
    half, asking = Visit("a", 9.0), Visit("a", 1.0, "answering")
    assert superfluous([asking, half], "a", 100, 1) is half


def test_as_many_strangers_of_one_address_stay_as_may() -> None:
    many = [Visit("a", float(n)) for n in range(STRANGERS)]
    assert superfluous(many, "a", 1000) is None
    assert superfluous([*many, Visit("a", 99.0)], "a", 1000) is many[0]
    assert superfluous([*many, Visit("b", 99.0)], "b", 1000) is None
    assert superfluous([*many, Visit("a", 99.0, known=True)], "a", 1000) is None
