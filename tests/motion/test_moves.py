from __future__ import annotations

import math
import random
from dataclasses import replace
from itertools import pairwise

import pytest
from benchtop import DISC, PART, TALL, TRIANGLE, WIDE, bench, collisions, moved, refused, stands
from oracles.inverse import ik

from pico.model.lab import Box2, KeepOut
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import fk, tool_pose
from pico.motion.types import Blocked, MovePath

TRANSIT_DIP = 0.5
"""No swing comes lower than this below the transit height [mm]."""
SETUP = bench()
ARM = SETUP.lab.robots["arm1"]
MOTION = ArmMotion(SETUP)
START, GOAL = Pose(290, 300, 10), Pose(620, 420, 40)
ALONE = stands(at={"a": (PART, START)})


def heights(path, name):
    return [fk(joints)[0][2] for segment in path.segments if segment.name == name for joints in segment.joints]


def test_a_move_goes_down_grips_lifts_swings_and_sets_down():
    path = moved(MOTION.move("arm1", "a", START, GOAL, 0, ALONE))
    names = [segment.name for segment in path.segments]
    assert names == ["approach", "descend", "grip", "lift", "transit", "lower", "release", "retreat"]
    assert [segment.opening for segment in path.segments] == [54, 54, 34, 34, 34, 34, 54, 54]
    assert path.segments[0].joints[0] == MOTION.park_joints("arm1")
    for one, other in pairwise(path.segments):
        assert other.joints[0] == pytest.approx(one.joints[-1], abs=1e-9)
        assert one.times[0] == 0 and len(one.times) == len(one.joints)
    picked, placed = path.segments[2].joints[-1], path.segments[6].joints[-1]
    assert tool_pose(ARM, picked)[:3] == pytest.approx((290, 300, 100), abs=1e-6)
    assert tool_pose(ARM, placed)[:3] == pytest.approx((620, 420, 100), abs=1e-6)


@pytest.mark.parametrize(("component", "geometry", "grasp_yaw"), [("a", PART, 0), ("a", PART, 90), ("disc", DISC, 33)])
def test_the_part_is_set_down_as_it_should_stand(component, geometry, grasp_yaw):
    """The jaws keep their direction in the part's frame: no half turn gets lost between pick and place."""
    standing = stands(at={component: (geometry, START)})
    path = moved(MOTION.move("arm1", component, START, Pose(620, 420, -150), grasp_yaw, standing))
    grips = [tool_pose(ARM, path.segments[i].joints[-1])[3] for i in (2, 6)]
    assert math.remainder(grips[0] - (10 + grasp_yaw), 180) == pytest.approx(0, abs=1e-6)
    assert math.remainder(grips[1] - grips[0] - (-150 - 10), 360) == pytest.approx(0, abs=1e-6)


def test_the_tool_stays_vertical_and_never_sinks_while_it_swings():
    rng = random.Random(2)
    for _ in range(30):
        start, goal = (Pose(rng.uniform(150, 800), rng.uniform(200, 500), rng.uniform(-180, 180)) for _ in range(2))
        path = MOTION.move("arm1", "a", start, goal, 0, {})
        if not isinstance(path, MovePath):
            continue
        for segment in path.segments:
            assert all(fk(joints)[1][2][2] == pytest.approx(-1, abs=1e-9) for joints in segment.joints)
        assert min(heights(path, "transit")) > ARM.transit_height - TRANSIT_DIP


def test_the_same_question_has_the_same_answer():
    standing = stands(at={"a": (PART, START), "post": (TALL, Pose(450, 370))})
    first = ArmMotion(SETUP).move("arm1", "a", START, GOAL, 0, standing)
    MOTION.move("arm1", "b", GOAL, START, 90, {})  # what was asked before makes no difference
    assert MOTION.move("arm1", "a", START, GOAL, 0, dict(reversed(standing.items()))) == first


def test_a_tall_post_at_the_goal_is_named():
    standing = ALONE | stands(at={"post": (TALL, Pose(GOAL.x + 20, GOAL.y, 40))})
    blocked = refused(MOTION.move("arm1", "a", START, GOAL, 0, standing))
    assert (blocked.kind, blocked.obstacle) == ("collision", "post")
    assert blocked.by is not None and blocked.by > 5
    assert "post" in blocked.text and " mm" in blocked.text


def test_a_neighbor_under_the_fingers_is_named():
    standing = ALONE | stands(at={"b": (DISC, START.compose(Pose(64, 0)))})
    blocked = refused(MOTION.move("arm1", "a", START, GOAL, 0, standing))
    assert (blocked.kind, blocked.obstacle, blocked.segment, blocked.by) == ("collision", "b", "descend", 2.0)
    assert blocked.text == f"a finger of arm1 would hit b by 2.0 mm, going down to a at {START}"
    moved(MOTION.move("arm1", "a", START, GOAL, 90, standing))  # across, there is room


def test_a_part_that_touches_its_neighbor_can_still_be_lifted():
    touching = ALONE | stands(at={"b": (PART, START.compose(Pose(60, 0)))})
    moved(MOTION.move("arm1", "a", START, GOAL, 90, touching))


def test_a_part_is_not_set_down_nearer_to_another_than_the_margin():
    standing = ALONE | stands(at={"b": (PART, GOAL.compose(Pose(61, 0)))})
    blocked = refused(MOTION.move("arm1", "a", START, GOAL, 90, standing))
    assert (blocked.segment, blocked.obstacle) == ("lower", "b")
    assert blocked.text.startswith("a in the hand of arm1 would come within 1.0 mm of b (2 mm are kept)")
    moved(MOTION.move("arm1", "a", START, GOAL, 90, ALONE | stands(at={"b": (PART, GOAL.compose(Pose(62, 0)))})))


def test_a_post_on_the_straight_way_is_gone_around():
    straight = moved(MOTION.move("arm1", "a", START, GOAL, 90, ALONE))
    x, y, *_ = tool_pose(ARM, straight.segments[4].joints[len(straight.segments[4].joints) // 2])
    standing = ALONE | stands(at={"post": (TALL, Pose(x, y))})
    around = moved(MOTION.move("arm1", "a", START, GOAL, 90, standing))
    assert around.seconds > straight.seconds
    assert not collisions(MOTION, around, PART, START, GOAL, 90, standing)
    assert any("post" in hit for hit in collisions(MOTION, straight, PART, START, GOAL, 90, standing))


def test_a_keep_out_zone_over_the_goal_is_named():
    zone = KeepOut(area=Box2(x=(560, 700), y=(350, 500)), z=(200, 400), reason="lamp")
    motion = ArmMotion(bench(keep_out={"lamp": zone}))
    blocked = refused(motion.move("arm1", "a", START, GOAL, 0, ALONE))
    assert (blocked.kind, blocked.obstacle) == ("keep_out", "lamp")
    assert "the keep-out zone lamp" in blocked.text


def test_an_arm_that_stands_low_rises_before_it_swings():
    low = ik(ARM, 620, 420, 100, 40)[0]
    standing = stands(at={"a": (PART, START), "b": (PART, Pose(620, 420, 40))})  # the fingers are around b
    path = moved(MOTION.move("arm1", "a", START, Pose(300, 450), 0, standing, low))
    approach = path.segments[0].joints
    for joints in approach:
        x, y, z, _ = tool_pose(ARM, joints)
        assert math.hypot(x - 620, y - 420) < 0.01 or z > ARM.transit_height - TRANSIT_DIP
    assert approach[0] == low


def test_a_part_moved_where_the_last_one_ended_needs_no_park_between():
    first = moved(MOTION.move("arm1", "a", START, GOAL, 0, ALONE))
    standing = stands(at={"a": (PART, GOAL), "b": (PART, Pose(400, 250))})
    second = moved(MOTION.move("arm1", "b", Pose(400, 250), START, 0, standing, first.end))
    assert second.segments[0].joints[0] == first.end


def test_parking_rises_and_ends_parked():
    standing = stands(at={"a": (PART, GOAL)})
    path = moved(MOTION.park("arm1", ik(ARM, GOAL.x, GOAL.y, 100, GOAL.yaw)[0], standing))
    assert [segment.name for segment in path.segments] == ["park"]
    assert path.end == MOTION.park_joints("arm1")
    assert MOTION.park("arm1", path.end, standing).seconds == 0


def test_a_tilted_tool_is_brought_upright_first():
    tilted = (0.2, -0.6, 0.1, 0.7, 0.3, 0.9, 0.0)
    path = moved(MOTION.move("arm1", "a", START, GOAL, 0, ALONE, tilted))
    assert path.segments[0].joints[0] == tilted
    assert fk(path.segments[0].joints[-1])[1][2][2] == pytest.approx(-1)


def test_the_other_arm_in_the_way_is_named():
    robots = {"arm1": ARM, "arm2": Robot(mount=Mount(x=480, y=100, yaw=90))}
    motion = ArmMotion(bench(robots=robots))
    blocked = refused(motion.move("arm1", "a", START, Pose(480, 290), 0, ALONE))
    assert (blocked.kind, blocked.obstacle) == ("collision", "arm2")


@pytest.mark.parametrize("neighbor", [PART, WIDE])
def test_mirrored_tables_have_mirrored_answers(neighbor):
    """Where only the hand comes near to what stands there: links bulge to one side of the arm's plane."""
    rng, seen = random.Random(7), set()
    for _ in range(10):
        start, goal = (Pose(480 + rng.uniform(-300, 300), rng.uniform(250, 480)) for _ in range(2))
        beside = Pose(480 + rng.uniform(-200, 200), rng.uniform(300, 480))
        answers = []
        for side in (1, -1):
            a, b, p = (Pose(480 + side * (q.x - 480), q.y) for q in (start, goal, beside))
            answers.append(MOTION.move("arm1", "a", a, b, 0, stands(at={"a": (PART, a), "b": (neighbor, p)})))
        assert type(answers[0]) is type(answers[1])
        seen.add(type(answers[0]))
        if isinstance(answers[0], MovePath):
            assert answers[0].seconds == pytest.approx(answers[1].seconds, rel=1e-6)
    assert seen == {MovePath, Blocked}


@pytest.mark.parametrize("count", [4, pytest.param(12, marks=pytest.mark.slow)])
def test_accepted_paths_collide_nowhere_when_looked_at_four_times_finer(count):
    rng = random.Random(11)
    kinds = {"tall": TALL, "disc": DISC, "part": PART, "triangle": TRIANGLE, "wide": WIDE}
    accepted = refusals = 0
    while accepted < count:
        poses: list[Pose] = []
        while len(poses) < 14:
            pose = Pose(rng.uniform(120, 840), rng.uniform(120, 520), rng.uniform(-180, 180))
            if all(pose.distance(other) > 92 for other in poses) and math.hypot(pose.x - 480, pose.y - 760) > 260:
                poses.append(pose)
        names = ["tall", "tall", *(["part", "disc", "triangle", "part", "disc"] * 2)]
        standing = stands(at={f"t{i}": (kinds[n], p) for i, (n, p) in enumerate(zip(names, poses[2:], strict=True))})
        component, geometry = rng.choice([("a", PART), ("disc", DISC)])
        yaw = rng.choice([0, 90])
        answer = MOTION.move("arm1", component, poses[0], poses[1], yaw, standing)
        if not isinstance(answer, MovePath):
            refusals += 1
            continue
        accepted += 1
        assert collisions(MOTION, answer, geometry, poses[0], poses[1], yaw, standing) == []
    assert refusals < 50


def test_jaws_that_close_askew_on_a_square_part_are_refused():
    blocked = refused(MOTION.move("arm1", "a", START, GOAL, 33, ALONE))
    assert (blocked.segment, blocked.obstacle) == ("grip", "a")


def test_a_vacuum_gripper_takes_a_part_by_its_top_and_needs_no_room_beside_it():
    motion = ArmMotion(bench(robots={"arm1": replace(ARM, gripper=Gripper(fingers="none"))}))
    standing = ALONE | stands(at={"b": (PART, START.compose(Pose(60, 0))), "c": (PART, START.compose(Pose(0, 60)))})
    path = moved(motion.move("arm1", "a", START, GOAL, 0, standing))
    assert tool_pose(ARM, path.segments[2].joints[0])[2] == pytest.approx(PART.height)
