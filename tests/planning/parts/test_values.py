"""Motors and set-points: beside the arm, never on a part that is carried, homed first where nobody knows."""

from __future__ import annotations

import pytest
from checker import check
from planning_benches import bench, planned, see, want

HERE, THERE = {"a": (300, 300)}, {"a": (500, 300)}


def test_a_motor_turns_while_the_arm_moves_something_else() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (600, 400)}, {"b": {"angle": 0.0}})
    wanted = want({"a": (500, 300), "b": (600, 400)}, {"b": {"angle": 90.0}})
    made = planned(setup, seen, wanted)
    turn = next(o for o in made.operations if o.primitive == "set")
    assert (turn.start, turn.seconds, turn.resources) == (0.0, 3.0, ("motor/b.angle", "b"))
    assert made.makespan == 13.0  # a nominal move and the park
    assert check(setup, seen, wanted, made) == []


def test_a_motor_waits_while_its_component_is_carried() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, HERE, {"a": {"angle": 0.0}})
    made = planned(setup, seen, want(THERE, {"a": {"angle": 90.0}}))
    turn = next(o for o in made.operations if o.primitive == "set")
    assert turn.start == 10.0


def test_an_axis_that_nobody_knows_is_homed_first() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, HERE, {"a": {"angle": None}})
    home, turn = planned(setup, seen, want(HERE, {"a": {"angle": 90.0}})).operations
    assert (home.primitive, home.arguments) == ("home", {"tunable": "angle"})
    assert turn.after == (home.id,)
    assert turn.seconds == 3.0  # from the home position


def test_a_period_counts() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, HERE, {"a": {"angle": 350.0}})
    assert planned(setup, seen, want(HERE, {"a": {"angle": 10.0}})).makespan == pytest.approx(20 / 30, abs=1e-6)
    assert planned(setup, seen, want(HERE, {"a": {"angle": -10.0}})).operations == ()


def test_what_only_a_person_sets_asks_a_person_and_holds_the_arm() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, HERE, {"a": {"filter": "red"}})
    (operation,) = planned(setup, seen, want(HERE, {"a": {"filter": "blue"}})).operations
    assert (operation.primitive, operation.reason.kind) == ("operator", "operator")
    assert operation.resources == ("a", "arm1")


def test_set_points_of_one_component_follow_one_another() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, HERE, {"a": {"angle": 0.0, "exposure": 1.0}})
    made = planned(setup, seen, want(HERE, {"a": {"angle": 30.0, "exposure": 2.0}}))
    assert [(o.arguments["tunable"], o.start) for o in made.operations] == [("angle", 0.0), ("exposure", 1.0)]
