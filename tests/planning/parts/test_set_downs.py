"""What a hand holds is set down first: where it was picked, at home, or in the nearest slot that is free."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from planning_benches import SLOTS, bench, moves, planned, see, want

from pico.model.lab import Slot, Table
from pico.model.observation import Observation, ObservedRobot
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.types import Blocked, MovePath, Segment
from pico.planning.parts.setdown import TRIES, set_downs

THREE = {**SLOTS, "s3": Slot(x=260, y=60)}


def holding(setup: Setup, others: dict[str, Any], picked: Pose | None = None) -> Observation:
    """`a` in the hand of arm1, above the middle of the table."""
    seen = see(setup, {"a": (400, 300), **others})
    parts = {**seen.components, "a": replace(seen.components["a"], presence="held")}
    return replace(seen, components=parts, robots={"arm1": ObservedRobot(joints=(), holding="a", picked=picked)})


def first(made: Plan) -> tuple[str, str | None, Pose]:
    op = made.operations[0]
    assert op.reason.kind == "held"
    assert op.arguments["from"]["held"]
    return op.component, op.arguments["to"].get("slot"), Pose(**op.arguments["to"]["pose"])


@pytest.mark.parametrize(
    ("others", "picked", "slot", "where"),
    [
        ({}, Pose(600, 300, 0), None, Pose(600, 300, 0)),
        ({}, None, "s1", Pose(60, 60, 0)),
        ({"b": (600, 310)}, Pose(600, 300, 0), "s1", Pose(60, 60, 0)),
        ({"b": "s1"}, None, "s2", Pose(160, 60, 0)),
        ({"b": "s1"}, Pose(250, 60, 0), None, Pose(250, 60, 0)),  # exactly there, in a slot as well
    ],
)
def test_a_held_part_goes_where_it_was_picked_or_to_a_free_slot(
    others: dict[str, Any], picked: Pose | None, slot: str | None, where: Pose
) -> None:
    setup = bench({"a": "block", "b": "block"}, THREE)
    made = planned(setup, holding(setup, others, picked), want({"a": (500, 300), **others}))
    assert first(made) == ("a", slot, where)
    assert moves(made)[-1] == ("a", "500,300")
    assert not made.diagnostics
    assert made.absent == ()


def test_nothing_else_begins_before_the_hand_is_empty() -> None:
    setup = bench({"a": "block", "b": "block"}, THREE)
    seen = holding(setup, {"b": (600, 300)})
    made = planned(setup, seen, want({"a": "s1", "b": (200, 300)}, {"b": {"exposure": 3.0}}))
    rest = list(made.operations[1:])
    ends = {made.operations[0].id}
    for op in rest:
        assert ends & set(op.after), op
        ends.add(op.id)


def test_an_arm_that_only_set_something_down_parks() -> None:
    setup = bench({"a": "block"}, THREE)
    made = planned(setup, holding(setup, {}), want({"a": "s1"}))
    assert [op.primitive for op in made.operations] == ["stow", "park"]


def test_where_there_is_no_place_it_is_said_and_the_part_stays_in_the_hand() -> None:
    setup = bench({"a": "block", "b": "block"}, {"s1": SLOTS["s1"]})
    made = planned(setup, holding(setup, {"b": "s1"}), want({"a": (500, 300), "b": "s1"}))
    assert made.operations == ()
    assert [d.code for d in made.diagnostics] == ["held"]
    assert "no storage slot is free" in made.diagnostics[0].summary


class Hands:
    """Arms that reach what is right of `least`, and set down where none of the others stands as if at 9 rad."""

    def __init__(self, least: float = 0.0) -> None:
        self.least = least

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        return None if pose.x > self.least else Blocked("reach", "too far")

    def set_down(self, robot: str, component: str, *rest: Any) -> MovePath | Blocked:
        if (9.0,) in rest[-1].values() and robot == "arm1":
            return Blocked("collision", "it would hit arm2", obstacle="arm2")
        return MovePath(robot, component, (Segment("lower", (0.0, 1.0), ((0.0,), (0.0,)), 0.0),))


def test_a_hand_that_another_was_in_the_way_of_is_emptied_after_that() -> None:
    robots = {f"arm{n}": Robot(mount=Mount(x=400, y=500, yaw=-90)) for n in (1, 2)}
    setup, motion = bench({"a": "block", "b": "block"}, THREE, robots=robots), Hands()
    seen = see(setup, {"a": (300, 300), "b": (500, 300)})
    parts = {n: replace(c, presence="held") for n, c in seen.components.items()}
    hands = {"arm1": ObservedRobot(joints=(1.0,), holding="a"), "arm2": ObservedRobot(joints=(9.0,), holding="b")}
    held: Any = motion
    found = set_downs(setup, replace(seen, components=parts, robots=hands), held)
    assert [(o.robot, o.component) for o in found.operations] == [("arm2", "b"), ("arm1", "a")]
    assert found.diagnostics == () and found.operations[1].after == (found.operations[0].id,)


def test_slots_out_of_reach_do_not_count_as_tried() -> None:
    row = {f"s{n:02}": Slot(x=60 + 100 * n, y=60) for n in range(TRIES + 6)}
    setup = bench({"a": "block"}, row, table=Table(size=(2000, 500)))
    far: Any = Hands(least=60 + 100 * (TRIES + 4))
    (found,) = set_downs(setup, holding(setup, {}), far).operations
    assert found.arguments["to"]["slot"] == f"s{TRIES + 5}"
    nowhere: Any = Hands(least=2000)
    (told,) = set_downs(setup, holding(setup, {}), nowhere).diagnostics
    assert told.summary == "arm1 holds a and can't set it down: too far"
