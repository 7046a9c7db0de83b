"""One operation at a time, and where a part goes that is placed behind another."""

from __future__ import annotations

from dataclasses import replace

import pytest
from planning_benches import TYPES, bench, moves, one, part, see, want

from pico.diagnostics import PicoError
from pico.model.catalog import Frames
from pico.model.pose import Pose
from pico.model.request import place_after
from pico.model.setup import Setup
from pico.planning import home_one, move_one, set_values


def test_a_single_move_is_one_move_for_the_reason_that_it_was_asked_for() -> None:
    setup = bench({"a": "block", "b": "block"})
    made = one(move_one, setup, see(setup, {"a": (300, 300), "b": (500, 300)}), "a", Pose(400, 400))
    assert moves(made) == [("a", "400,400")]
    assert made.operations[0].reason.kind == "asked"
    assert [c.component for c in made.changes] == ["a"]


def test_a_single_move_moves_even_by_less_than_the_tolerance() -> None:
    setup = bench({"a": "block"})
    assert len(moves(one(move_one, setup, see(setup, {"a": (300, 300)}), "a", Pose(300.2, 300)))) == 1


def test_a_single_move_to_a_slot_stows() -> None:
    setup = bench({"a": "block"})
    made = one(move_one, setup, see(setup, {"a": (300, 300)}), "a", "s2")
    assert [(o.primitive, o.component) for o in made.operations] == [("stow", "a"), ("park", "arm1")]


def test_a_single_move_moves_nothing_else_out_of_the_way() -> None:
    setup = bench({"a": part("one_way"), "left": "block"})
    made = one(move_one, setup, see(setup, {"a": (300, 300), "left": (236, 300)}), "a", Pose(500, 300))
    assert made.errored and "left" in made.diagnostics[0].summary


@pytest.mark.parametrize("where", ["s9", Pose(0, 0)])
def test_what_makes_no_sense_is_an_error(where: str | Pose) -> None:
    setup = bench({"a": "block"})
    with pytest.raises(PicoError):
        one(move_one, setup, see(setup, {"a": (300, 300)}), "b" if isinstance(where, Pose) else "a", where)


def test_one_value_is_set() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (500, 300)}, {"a": {"angle": 0.0}, "b": {"angle": None}})
    (turn,) = one(set_values, setup, seen, "a", {"angle": 90.0}).operations
    assert (turn.arguments["from"], turn.arguments["to"], turn.reason.kind) == (0.0, 90.0, "asked")
    assert one(set_values, setup, seen, "a", {"angle": 0.0}).operations == ()
    assert [o.primitive for o in one(set_values, setup, seen, "b", {"angle": 0.0}).operations] == ["home", "set"]


def test_one_axis_is_homed() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, {"a": (300, 300)}, {"a": {"angle": 60.0, "exposure": 1.0}})
    (home,) = one(home_one, setup, seen, "a", "angle").operations
    assert (home.primitive, home.seconds) == ("home", 2.0)
    with pytest.raises(PicoError, match="no axis to home"):
        one(home_one, setup, seen, "a", "exposure")


def test_optical_centers_lie_apart_by_the_distance_along_the_beam() -> None:
    off = replace(TYPES["block"], name="off", frames=Frames(optical=(10, 5, 70)))
    setup = bench({"a": "block", "b": part("off")})
    setup = Setup(lab=setup.lab, catalog={**TYPES, "off": off})
    places = {"a": (300.0, 300.0, 90.0)}
    for where in (see(setup, places), want(places)):
        pose = place_after(setup, where, "b", "a", 125)
        assert (pose.x, pose.y, pose.yaw) == pytest.approx((305, 415, 90))
        assert pose.apply(10, 5) == pytest.approx((300, 425))
