"""An arm that uses a tool: taken, lowered over places, turned there, put back; clear of all else, or said why not."""

from __future__ import annotations

from itertools import pairwise

import pytest
from benchtop import ARM, PART, TALL, bench, collisions, refused, stands

from pico.model.pose import Pose, angle_between
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import Blocked, MovePath, StandingObject, Waypoint

START, OVER = Pose(300, 400, 10), Pose(520, 420, 30)
STANDING = stands(at={"a": (PART, START), "b": (PART, OVER)})


def used(*points: Waypoint, standing: dict[str, StandingObject] = STANDING) -> tuple[MovePath, ...] | Blocked:
    return ArmMotion(bench()).use("arm1", "a", START, points, standing)


def ways(*points: Waypoint) -> tuple[MovePath, ...]:
    found = used(*points)
    assert not isinstance(found, Blocked), found
    return found


@pytest.mark.parametrize("turn", [120.0, -200.0, 0.0])
def test_a_tool_is_lowered_turned_and_put_back_where_it_stood(turn: float) -> None:
    take, use, back = ways(Waypoint(OVER, 145.0, turn))
    assert [s.name for s in take.segments] == ["approach", "descend", "grip", "lift"]
    assert [s.name for s in back.segments] == ["lift", "transit", "lower", "release", "retreat"]
    for before, after in pairwise((*take.segments, *use.segments, *back.segments)):
        assert before.joints[-1] == pytest.approx(after.joints[0], abs=1e-9)
    held = take.segments[2].joints[-1]
    yaws = [tool_pose(ARM, q)[3] for q in (held, *(s.joints[-1] for s in use.segments[1:]))]
    x, y, z, _ = tool_pose(ARM, use.segments[-1].joints[-1])
    assert (x, y, z) == pytest.approx((OVER.x, OVER.y, 245.0), abs=1e-3)
    assert angle_between(yaws[0] - START.yaw, yaws[1] - OVER.yaw) == pytest.approx(0, abs=1e-3)
    assert use.segments[1].joints[-1][6] - use.segments[-1].joints[-1][6] == pytest.approx(turn * 3.14159265 / 180)
    assert tool_pose(ARM, back.segments[2].joints[-1])[:3] == pytest.approx((START.x, START.y, 100), abs=1e-3)


def test_on_all_of_these_ways_nothing_is_hit() -> None:
    motion = ArmMotion(bench())
    found = ways(Waypoint(OVER, 145.0, 90.0), Waypoint(Pose(600, 380, 0), 60.0, -45.0))
    yaw = PART.grasp.yaws[0] if PART.grasp else 0.0
    assert [collisions(motion, path, PART, START, START, yaw, STANDING) for path in found] == [[]] * 3


def test_what_a_tool_would_be_lowered_into_blocks_it() -> None:
    why = refused(used(Waypoint(OVER, 120.0, 90.0)))  # type: ignore[arg-type]
    assert why.kind == "collision" and why.obstacle == "b"


def test_higher_than_the_arm_carries_and_farther_than_it_reaches_is_told() -> None:
    assert refused(used(Waypoint(OVER, 200.0))).kind == "height"  # type: ignore[arg-type]
    assert refused(used(Waypoint(Pose(1190, 10), 145.0))).kind == "reach"  # type: ignore[arg-type]
    around = refused(used(Waypoint(OVER, 145.0, 900.0)))  # type: ignore[arg-type]
    assert around.kind == "reach" and "turn it there by 900 deg" in around.text


def test_what_stands_in_the_way_of_the_turn_blocks_it() -> None:
    beside = {**STANDING, **stands(at={"c": (TALL, Pose(OVER.x + 60, OVER.y + 10, 0))})}
    assert isinstance(used(Waypoint(OVER, 145.0, 90.0), standing=beside), Blocked)
