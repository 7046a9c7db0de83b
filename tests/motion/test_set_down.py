"""The rest of a move that was cut short: from wherever the arm holds the part, to a place, by both collision checks."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parent.parent / "execution"))

from benches import shel

from pico.model.catalog import Footprint, Geometry
from pico.model.pose import Pose
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_of
from pico.motion.types import Blocked, MovePath, StandingObject

SETUP, STATE = shel()
GEOMETRY = SETUP.type_of("p1").geometry
START, GOAL = Pose(110, 220, 0), Pose(420, 420, 30)


@pytest.fixture(scope="module")
def motion() -> ArmMotion:
    return ArmMotion(SETUP)


def moved(motion: ArmMotion, standing: dict[str, StandingObject]) -> MovePath:
    path = motion.move("arm1", "p1", START, GOAL, 90.0, standing)
    assert isinstance(path, MovePath)
    return path


@pytest.mark.parametrize("segment", ["lift", "transit", "lower"])
@pytest.mark.parametrize("goal", [START, GOAL, Pose(200, 310, 90)])
def test_from_anywhere_on_its_way_a_part_can_be_brought_down(motion: ArmMotion, segment: str, goal: Pose) -> None:
    path = moved(motion, {})
    leg = next(s for s in path.segments if s.name == segment)
    joints = leg.joints[len(leg.joints) // 2]
    robot = SETUP.lab.robots["arm1"]
    grip = next(s for s in path.segments if s.name == "grip")
    in_hand = tool_of(robot, grip.joints[-1]).inverse().compose(START)
    held = tool_of(robot, joints).compose(in_hand)
    down = motion.set_down("arm1", "p1", held, goal, {}, joints)
    assert isinstance(down, MovePath)
    assert [s.name for s in down.segments] == ["lift", "transit", "lower", "release", "retreat"]
    assert down.segments[0].joints[0] == joints
    released = next(s for s in down.segments if s.name == "release").joints[-1]
    where = tool_of(robot, released).compose(in_hand)
    assert where.distance(goal) < 0.01
    assert abs((where.yaw - goal.yaw + 180) % 360 - 180) < 0.01


def test_a_place_that_is_taken_is_refused_by_name(motion: ArmMotion) -> None:
    path = moved(motion, {})
    joints = next(s for s in path.segments if s.name == "transit").joints[0]
    standing = {"p2": StandingObject(GOAL, GEOMETRY)}
    found = motion.set_down("arm1", "p1", START, GOAL, standing, joints)
    assert isinstance(found, Blocked)
    assert (found.obstacle, found.segment, found.kind) == ("p2", "lower", "collision")
    assert "p2" in found.text and "disagree" not in found.text


def test_a_wall_on_the_way_and_a_roof_over_the_hand_are_told_with_what_the_arm_does_there(motion: ArmMotion) -> None:
    path = moved(motion, {})
    tall = Geometry(footprint=Footprint(box=(40, 40)), height=500, mass=2.0)
    over = next(s for s in path.segments if s.name == "transit").joints[0]
    wall = {f"w{n}": StandingObject(Pose(250 + 12 * n, 180 + 42 * n), tall) for n in range(7)}
    found = motion.set_down("arm1", "p1", START, GOAL, wall, over)
    assert isinstance(found, Blocked) and found.segment == "transit" and found.obstacle in wall
    assert "disagree" not in found.text and str(found.obstacle) in found.text
    low = next(s for s in path.segments if s.name == "lift").joints[0]
    beside = {"near": StandingObject(Pose(START.x + 66, START.y), tall)}
    struck = motion.set_down("arm1", "p1", START, GOAL, beside, low)
    assert isinstance(struck, Blocked) and (struck.segment, struck.obstacle) == ("lift", "near")
    assert "disagree" not in struck.text


def test_an_arm_that_was_stopped_at_speed_among_neighbours_sets_down(motion: ArmMotion) -> None:
    neighbour = {"ly_150": StandingObject(Pose(110, 310, 0), SETUP.type_of("ly_150").geometry)}
    lift = next(s for s in moved(motion, neighbour).segments if s.name == "lift")
    q = lift.joints[1]
    askew = (q[0], q[1] + 0.0015, 2e-6, q[3], 5e-6, q[5], q[6])
    swung = tool_of(SETUP.lab.robots["arm1"], askew).compose(Pose(0.9, -1.7, 0))
    for held in (START, swung):
        assert isinstance(motion.set_down("arm1", "p1", held, START, neighbour, askew), MovePath)
