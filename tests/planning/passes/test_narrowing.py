"""A plan for some components changes only these, and says what it leaves."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, lit, op

from pico.planning.passes.comparison import compared
from pico.planning.passes.draft import Draft
from pico.planning.passes.narrowing import narrowed

THERE = {"a": (400, 300), "b": (600, 300)}


def changed(draft: Draft) -> list[str]:
    return [c.component for c in draft.changes]


def test_a_plan_for_all_is_as_it_was() -> None:
    draft = compared(begun(lit(), wanted=THERE))
    assert narrowed(draft) == draft


def test_what_is_not_asked_for_counts_only_where_it_moves_all_the_same() -> None:
    draft = replace(compared(begun(lit(), wanted=THERE, targets=("a",))), operations=(op("a", robot="arm1"),))
    found = narrowed(draft)
    assert changed(found) == ["a"] and [d.code for d in found.diagnostics] == ["left"]
    both = narrowed(replace(draft, operations=(*draft.operations, op("b", robot="arm1"))))
    assert changed(both) == ["a", "b"] and [d.code for d in both.diagnostics] == ["pulled-in"]


def test_one_that_moves_alone_is_all_that_changes() -> None:
    assert changed(narrowed(compared(begun(lit(), wanted=THERE, alone="b")))) == ["b"]


def test_a_part_with_a_sample_that_nobody_named_is_excluded() -> None:
    setup = lit()
    held = {**setup.lab.inventory, "a": replace(setup.lab.inventory["a"], sample="NaCl")}
    found = narrowed(compared(begun(replace(setup, lab=replace(setup.lab, inventory=held)), wanted=THERE)))
    assert found.goal.target.exclude == ("a.pose",) and changed(found) == ["b"]
    assert [d.code for d in found.diagnostics] == ["sample"]
