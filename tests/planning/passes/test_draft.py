"""Passes are made one after the other; those that need a possible plan are left out where it is none."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, lit, op

from pico.diagnostics import error, warning
from pico.planning.passes.draft import Draft, made, where_possible


def one_more(draft: Draft) -> Draft:
    return replace(draft, operations=(*draft.operations, op(f"n{len(draft.operations)}")))


def test_each_pass_goes_on_from_the_one_before() -> None:
    found = made(begun(lit()), (one_more, where_possible(one_more, one_more)))
    assert [o.id for o in found.operations] == ["n0", "n1", "n2"]


def test_an_impossible_plan_has_no_operations_but_goes_on_being_told_of() -> None:
    said = begun(lit()).told(warning("odd", "odd"))
    assert len(made(said, (one_more, where_possible(one_more))).operations) == 2
    found = made(said.told(error("impossible", "no")), (one_more, where_possible(one_more)))
    assert found.operations == () and [d.code for d in found.diagnostics] == ["odd", "impossible"]


def test_an_error_that_is_found_on_the_way_leaves_the_operations() -> None:
    found = made(
        begun(lit()), (where_possible(one_more, lambda draft: draft.told(error("hand-full", "no")), one_more),)
    )
    assert found.errored and len(found.operations) == 2
