"""What is wrong with operations is told, and does not change them."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, holding, lit, op, setting

from pico.model.observation import ObservedRobot
from pico.model.robot import Mount, Robot
from pico.planning.passes.checking import asked_checked, beams_checked, operations_checked

OPEN = (setting("laser", "shutter", "open"),)
MOVE = (op("a", robot="arm1"),)
XARM = Robot(model="xarm7", mount=Mount(x=400, y=500, yaw=-90))


def test_a_shutter_does_not_open_over_a_hand_that_holds_something() -> None:
    found = operations_checked(replace(holding(begun(lit()), "a"), operations=OPEN))
    assert [d.code for d in found.diagnostics] == ["hand-full"] and found.operations == OPEN


def test_light_that_somebody_asked_for_and_nobody_lets_out_is_an_error() -> None:
    draft = replace(begun(lit(strong=True)), operations=OPEN)
    assert [(d.severity, d.code) for d in asked_checked(draft).diagnostics] == [("error", "unarmed")]
    assert operations_checked(draft).diagnostics == ()  # a plan to a state leaves it out before


def test_an_arm_that_stays_where_it_was_stopped_is_told_of() -> None:
    draft = begun(lit(robots={"arm1": XARM}))
    draft = replace(draft, seen=replace(draft.seen, robots={"arm1": ObservedRobot(joints=(0.3,) * 7)}))
    assert [d.code for d in operations_checked(draft).diagnostics] == ["not-parked"]
    assert operations_checked(replace(draft, operations=MOVE)).diagnostics == ()


def test_beams_are_followed_only_where_something_is_done() -> None:
    assert beams_checked(begun(lit())) == begun(lit())
