"""Moves in an order that works, with the park at their end; or why there is none."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, lit, op, waits

from pico.model.plan import Staging
from pico.planning.passes.comparison import compared
from pico.planning.passes.draft import Draft
from pico.planning.passes.moves import moves_ordered

SWAP = {"a": (500, 300), "b": (300, 300)}


def test_one_of_two_that_swap_is_put_down_meanwhile() -> None:
    found = moves_ordered(compared(begun(lit(), wanted=SWAP)))
    assert found.staging == Staging(count=1, lower_bound=1, proven=True)
    assert [o.primitive for o in found.operations] == ["stow", "move", "move", "park"]
    ids = [o.id for o in found.operations]
    assert len({*ids}) == 4 and all({*o.after} <= {*ids[:n]} for n, o in enumerate(found.operations))
    assert found.operations[-1].after == (ids[-2],)


def test_moves_come_after_what_the_plan_holds_already() -> None:
    draft = replace(compared(begun(lit(), wanted={"a": (400, 400)})), operations=(op("first"),))
    assert waits(moves_ordered(draft).operations) == {"first": (), "a": (), "arm1": ("a",)}


def refused(draft: Draft) -> str:
    found = moves_ordered(draft)
    assert found.errored and found.operations == ()
    return found.diagnostics[0].summary


def test_what_can_not_be_is_told_and_nothing_moves() -> None:
    assert "overlap" in refused(compared(begun(lit(), wanted={"a": (480, 300)})))
    full = compared(begun(lit(), wanted=SWAP, alone="a"))
    assert "overlap b" in refused(replace(full, changes=tuple(c for c in full.changes if c.component == "a")))


def test_where_nothing_moves_that_is_proven() -> None:
    found = moves_ordered(compared(begun(lit())))
    assert (found.operations, found.staging.proven, found.diagnostics) == ((), True, ())
