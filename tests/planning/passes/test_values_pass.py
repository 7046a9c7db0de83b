"""Tunables that differ are set, after their axes are homed."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, lit, waits

from pico.planning.passes.comparison import compared
from pico.planning.passes.values import values_set

THEN = {"a": {"angle": 30.0, "exposure": 2.0}}
SEEN = {"a": {"angle": None, "exposure": 1.0}}


def test_an_axis_is_homed_before_it_is_set_and_others_wait_for_nothing() -> None:
    found = values_set(compared(begun(lit(), values=SEEN, then=THEN)))
    assert [(o.primitive, o.component) for o in found.operations] == [("home", "a"), ("set", "a"), ("set", "a")]
    assert waits(found.operations) == {"a angle": (), "a angle 30.0": ("a angle",), "a exposure 2.0": ()}


def test_what_is_not_asked_for_or_withheld_stays() -> None:
    draft = compared(begun(lit(), values=SEEN, then=THEN, targets=("a.exposure",)))
    assert waits(values_set(draft).operations) == {"a exposure 2.0": ()}
    assert values_set(replace(draft, withheld={("a", "exposure"): {}})).operations == ()
