"""What differs, and which of it is asked for."""

from __future__ import annotations

import pytest
from drafts import begun, holding, lit

from pico.diagnostics import PicoError
from pico.planning.passes.comparison import compared

THERE = {"a": (400, 300), "b": (500.05, 300)}


def test_what_stands_elsewhere_is_to_be_moved_unless_it_is_tolerated() -> None:
    found = compared(begun(lit(), wanted=THERE, then={"a": {"angle": 5.0}}))
    assert {(c.component, c.tunable) for c in found.changes if not c.tolerated} == {("a", "pose"), ("a", "angle")}
    assert found.moving == ("a",) and found.only.everything
    assert compared(begun(lit(), wanted=THERE, exact=True)).moving == ("a", "b")


def test_only_what_is_named_is_asked_for() -> None:
    only = compared(begun(lit(), wanted=THERE, targets=("a.angle",))).only
    assert only.chosen("a", "angle") and not only.chosen("a") and not only.everything
    with pytest.raises(PicoError):
        compared(begun(lit(), targets=("nobody",)))


def test_a_robot_that_holds_something_has_no_free_gripper() -> None:
    assert compared(begun(lit())).robots == ("arm1",)
    assert compared(holding(begun(lit()), "a")).robots == ()
