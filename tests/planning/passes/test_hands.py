"""Hands are emptied first, all else comes after that, and arms that do nothing else park."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, holding, lit, op, waits

from pico.model.observation import ObservedRobot
from pico.model.operation import Reason
from pico.model.robot import Mount, Robot
from pico.planning.parts.selection import Selection
from pico.planning.passes.hands import arms_parked, hands_emptied, hands_first

HELD = Reason(kind="held")
XARM = Robot(model="xarm7", mount=Mount(x=400, y=500, yaw=-90))
OUT = {"arm1": ObservedRobot(joints=(0.3,) * 7)}


def test_an_emptied_hand_is_seen_empty_and_its_part_where_it_is_put() -> None:
    found = hands_emptied(holding(begun(lit()), "a"))
    assert found.seen.components["a"].presence == "seen" and found.seen.robots["arm1"].holding is None
    (down,) = found.operations
    assert down.reason.kind == "held" and down.arguments["to"]["slot"] == "s1"
    assert hands_emptied(begun(lit())) == begun(lit())


def test_what_waits_for_nothing_else_waits_for_the_hands() -> None:
    down, other = op("a", robot="arm1", reason=HELD), op("b", "a", robot="arm2", reason=HELD)
    rest = (op("c", robot="arm2"), op("d", "c"), op("e"))
    found = hands_first(replace(begun(lit()), operations=(down, other, *rest)))
    assert waits(found.operations) == {"a": (), "b": ("a",), "c": ("b",), "d": ("c",), "e": ("b",), "arm1": ("b",)}
    same = replace(begun(lit()), operations=rest)
    assert hands_first(same) == same


def test_an_arm_that_was_stopped_parks_before_another_moves() -> None:
    draft = begun(lit(robots={"arm1": XARM, "arm2": XARM}))
    draft = replace(draft, seen=replace(draft.seen, robots=OUT), operations=(op("a", robot="arm2"), op("b")))
    assert waits(arms_parked(draft).operations) == {"arm1": (), "a": ("arm1",), "b": ()}
    some = replace(draft, only=Selection(targets={"a": None}))
    assert arms_parked(some) == some  # whose arm that is nobody asked
