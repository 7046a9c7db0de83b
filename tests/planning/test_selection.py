"""Plans for some of the components: what they pull in, what they leave, and what they say about it."""

from __future__ import annotations

import pytest
from planning_benches import bench, moves, part, planned, see, want

from pico.diagnostics import PicoError


def test_only_the_targets_move() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)}, {"a": {"angle": 0.0}, "b": {"angle": 0.0}})
    wanted = want({"a": (300, 400), "b": (500, 400)}, {"a": {"angle": 9.0}, "b": {"angle": 9.0}})
    made = planned(setup, seen, wanted, targets=["a"])
    assert {(o.primitive, o.component) for o in made.operations} == {("move", "a"), ("set", "a"), ("park", "arm1")}
    assert {c.component for c in made.changes} == {"a"}
    (left,) = made.diagnostics
    assert (left.code, left.summary) == ("left", "b differs from the state wanted, and stays so")


def test_a_target_pulls_in_what_must_leave_first() -> None:
    setup = bench({"a": "block", "b": "block", "c": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300), "c": (100, 400)})
    wanted = want({"a": (500, 300), "b": (700, 300), "c": (200, 400)})
    made = planned(setup, seen, wanted, targets=("a",))
    assert moves(made) == [("b", "700,300"), ("a", "500,300")]
    pulled, left = made.diagnostics
    assert (pulled.severity, pulled.summary) == ("note", "b is moved as well: it is in the way of a")
    assert left.summary.startswith("c differs")


def test_a_target_pulls_in_what_leaves_no_room_for_the_fingers() -> None:
    setup = bench({"a": part("one_way"), "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (364, 300)})  # 4 mm apart along x, along which the jaws close
    made = planned(setup, seen, want({"a": (500, 300), "b": (364, 400)}), targets=("a",))
    assert moves(made) == [("b", "364,400"), ("a", "500,300")]
    assert [d.code for d in made.diagnostics] == ["pulled-in"]


def test_what_waits_for_something_excluded_stays_too() -> None:
    setup = bench({"a": "block", "b": "block", "c": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300), "c": (100, 400)})
    wanted = want({"a": (500, 300), "b": (700, 300), "c": (200, 400)})
    made = planned(setup, seen, wanted, exclude=("b",))
    assert moves(made) == [("c", "200,400")]
    assert [d.code for d in made.diagnostics] == ["blocked", "left"]
    assert made.diagnostics[0].summary.startswith("a is not moved: ")


def test_an_unknown_target_is_an_error() -> None:
    setup = bench({"a": "block"})
    with pytest.raises(PicoError, match="no component `b`"):
        planned(setup, see(setup, {"a": (300, 300)}), want({"a": (300, 400)}), targets=("b",))
