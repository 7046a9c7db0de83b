"""Ways of an arm whose part a person steers: a hair above its place, small steps, nothing too near, never fast."""

from __future__ import annotations

from itertools import pairwise
from math import dist

import pytest
from benchtop import ARM, PART, bench, moved, stands

from pico.model.lab import Box2, KeepOut
from pico.model.pose import Pose
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.setdown import HAIR
from pico.motion.types import Blocked, Joints, MovePath, StandingObject
from pico.teleop.frames import STEP_SECONDS
from pico.teleop.steps import IN_PLANE, SLOW
from pico.teleop.steps import moved as stepped

START = Pose(420, 420, 0)
STANDING = stands(at={"a": (PART, START), "b": (PART, Pose(500, 420))})


@pytest.fixture(scope="module")
def motion() -> ArmMotion:
    return ArmMotion(bench())


def steered(
    motion: ArmMotion, name: str, by: float, standing: dict[str, StandingObject], start: Pose = START
) -> tuple[Pose, Joints, str]:
    """Take a part in hand and step until that is refused, 40 times at most; return where it is, the arm, and why."""
    others = {n: thing for n, thing in standing.items() if n != "a"}
    joints, held = moved(motion.take("arm1", "a", start, 90.0, standing)).end, start
    for _ in range(40):
        goal = stepped(held, name, by)
        found = motion.shift("arm1", "a", held, goal, others, joints)
        if isinstance(found, Blocked):
            return held, joints, found.text
        joints, held = found.end, goal
    return held, joints, ""


def fastest(path: MovePath) -> float:
    """Return the greatest speed of the tool along a path [mm/s]."""
    found = [0.0]
    for segment in path.segments:
        points = [tool_pose(ARM, q)[:3] for q in segment.joints]
        gaps = [b - a for a, b in pairwise(segment.times)]
        found += [dist(a, b) / t for (a, b), t in zip(pairwise(points), gaps, strict=True) if t > 1e-9]
    return max(found)


def test_a_part_is_taken_where_it_stands_and_held_a_hair_above_it(motion: ArmMotion) -> None:
    path = moved(motion.take("arm1", "a", START, 90.0, STANDING))
    assert [s.name for s in path.segments] == ["approach", "descend", "grip", "lift"]
    x, y, z, _ = tool_pose(ARM, path.end)
    assert (x, y, z) == pytest.approx((START.x, START.y, 100.0 + HAIR), abs=1e-3)
    assert fastest(path) <= SLOW * 1.02


@pytest.mark.parametrize(("name", "by"), [(n, s * most) for n, (_, most) in IN_PLANE.items() for s in (-1, 1)])
def test_a_step_is_over_in_time_at_one_height_and_goes_where_it_should(motion: ArmMotion, name: str, by: float) -> None:
    joints = moved(motion.take("arm1", "a", START, 90.0, STANDING)).end
    others = {"b": STANDING["b"]}
    path = moved(motion.shift("arm1", "a", START, stepped(START, name, by), others, joints))
    assert path.seconds <= STEP_SECONDS * 1.2 and fastest(path) <= SLOW
    heights = [tool_pose(ARM, q)[2] for q in path.segments[0].joints]
    assert max(heights) - min(heights) < 0.05
    x, y, _, yaw = tool_pose(ARM, path.end)
    goal, (_, _, _, before) = stepped(START, name, by), tool_pose(ARM, joints)
    assert (x, y) == pytest.approx((goal.x, goal.y), abs=1e-3)
    assert (yaw - before - goal.yaw + 180) % 360 - 180 == pytest.approx(0.0, abs=1e-3)


def test_it_stops_before_a_neighbour_by_the_margin_and_may_go_back(motion: ArmMotion) -> None:
    held, joints, why = steered(motion, "x", 1.0, STANDING)
    margin = motion.setup.lab.margins.body
    assert 440.0 - margin - 1.0 <= held.x <= 440.0 - margin  # the bases are 60 mm wide
    assert "before b" in why and f"of which {margin:g} mm stay" in why
    back = motion.shift("arm1", "a", held, stepped(held, "x", -1.0), {"b": STANDING["b"]}, joints)
    assert isinstance(back, MovePath)


def test_a_part_that_could_not_be_set_down_again_is_not_taken(motion: ArmMotion) -> None:
    near = stands(at={"a": (PART, START), "b": (PART, Pose(481, 420))})
    found = motion.take("arm1", "a", START, 90.0, near)
    assert isinstance(found, Blocked) and "within 1.0 mm of b" in found.text


def test_keep_out_zones_and_the_reach_of_the_arm_stop_it() -> None:
    zone = KeepOut(area=Box2(x=(0, 1200), y=(470, 480)), z=(0, 60))
    found, _, why = steered(ArmMotion(bench(keep_out={"wall": zone})), "y", 1.0, stands(at={"a": (PART, START)}))
    assert found.y <= 440.0 and "wall" in why
    far = Pose(480, 100, 0)
    found, _, why = steered(ArmMotion(bench()), "y", -1.0, stands(at={"a": (PART, far)}), far)
    assert 80 < found.y < 95 and "it reaches" in why


def test_it_is_let_go_where_it_is(motion: ArmMotion) -> None:
    held, joints, _ = steered(motion, "x", -0.5, STANDING)
    path = moved(motion.let_go("arm1", "a", held, {"b": STANDING["b"]}, joints))
    assert [s.name for s in path.segments] == ["lift", "transit", "lower", "release", "retreat"]
    x, y, z, _ = tool_pose(ARM, path.segments[3].joints[-1])
    assert (x, y, z) == pytest.approx((held.x, held.y, 100.0), abs=1e-3)
    assert fastest(path) <= SLOW * 1.02
