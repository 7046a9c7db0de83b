"""Plans for some of the components: what they pull in, what they leave, and what they say about it."""

from __future__ import annotations

import pytest
from planning_benches import TYPES, bench, moves, part, planned, see, want

from pico.diagnostics import PicoError
from pico.model.catalog import ComponentType, OpticalElement, Tunable
from pico.model.setup import Setup


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


def test_those_that_wait_are_told_as_in_a_sentence() -> None:
    setup = bench(dict.fromkeys("abcd", "block"))
    seen = see(setup, {"a": (100, 400), "b": (200, 400), "c": (300, 400), "d": (500, 300)})
    wanted = want({"a": (455, 280), "b": (545, 280), "c": (500, 355), "d": (700, 300)})
    made = planned(setup, seen, wanted, targets=("a", "b", "c"))
    pulled = next(d for d in made.diagnostics if d.code == "pulled-in")
    assert pulled.summary == "d is moved as well: it is in the way of a, b and c"


def test_what_an_interlock_sets_is_not_told_as_changed() -> None:
    setup = bench({"a": "block", "laser": "laser"})
    laser = ComponentType(
        name="laser", title="Laser", geometry=TYPES["block"].geometry, optics=OpticalElement(element="source"),
        tunables={"shutter": Tunable(datatype="choice", choices=("open", "closed"))},
    )  # fmt: skip
    setup = Setup(lab=setup.lab, catalog={**TYPES, "laser": laser})
    seen = see(setup, {"a": (300, 300), "laser": (100, 300)}, {"laser": {"shutter": "open"}})
    wanted = want({"a": (300, 400), "laser": (100, 300)}, {"laser": {"shutter": "closed"}})
    made = planned(setup, seen, wanted, targets=["a"])
    assert [o.arguments["to"] for o in made.operations if o.component == "laser"] == ["closed", "open"]
    assert {(c.component, c.tunable) for c in made.changes} == {("a", "pose")}
    assert [d.summary for d in made.diagnostics if d.code == "left"] == [
        "laser differs from the state wanted, and stays so"
    ]


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


def test_one_tunable_of_a_component_may_be_asked_for_or_left_out() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)}, {"a": {"angle": 0.0}, "b": {"angle": 0.0}})
    wanted = want({"a": (300, 400), "b": (500, 400)}, {"a": {"angle": 9.0}, "b": {"angle": 9.0}})
    made = planned(setup, seen, wanted, targets=["a.angle"])
    assert [(o.primitive, o.component) for o in made.operations] == [("set", "a")]
    assert [(c.component, c.tunable) for c in made.changes] == [("a", "angle")]
    assert [d.summary for d in made.diagnostics] == ["a.pose, b differ from the state wanted, and stay so"]
    rest = planned(setup, seen, wanted, exclude=["a.angle", "b"])
    assert moves(rest) == [("a", "300,400")] and "set" not in {o.primitive for o in rest.operations}


def test_a_component_asked_for_its_angle_alone_still_makes_way() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)}, {"b": {"angle": 0.0}})
    wanted = want({"a": (500, 300), "b": (700, 300)}, {"b": {"angle": 9.0}})
    made = planned(setup, seen, wanted, targets=("a", "b.angle"))
    assert moves(made) == [("b", "700,300"), ("a", "500,300")]
    assert [d.summary for d in made.diagnostics] == ["b is moved as well: it is in the way of a"]


@pytest.mark.parametrize(
    ("targets", "exclude", "said"),
    [
        (["a.angel"], [], "a has no tunable `angel`"),
        (["c.angle"], [], "the lab has no component `c`"),
        (["a.pose.x"], [], "a has no tunable `pose.x`"),
        (["a."], [], "a has no tunable ``"),
        (["a.angle"], ["a"], "a.angle is both asked for and excluded"),
        (["a.angle"], ["a.angle"], "a.angle is both asked for and excluded"),
    ],
)
def test_what_the_lab_does_not_have_can_not_be_asked_for(targets: list[str], exclude: list[str], said: str) -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)}, {"a": {"angle": 0.0}})
    with pytest.raises(PicoError, match=said):
        planned(setup, seen, want({"a": (300, 400)}), targets=targets, exclude=exclude)
