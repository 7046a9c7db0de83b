"""Figures of motion against closed forms, brute force and references of their own."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from itertools import pairwise

import mujoco
import numpy as np
import pytest
import shapely
from benchtop import ARM, DISC, PART, TALL, TRIANGLE, bench, stands
from oracles.inverse import ik
from shapely.geometry import Point, Polygon

from pico.model.body import Body
from pico.model.catalog import Footprint, Geometry, Grasp
from pico.model.lab import Box2, KeepOut, Table
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.motion import frames, gantry, timing
from pico.motion.arms import ARM_REACH, ArmMotion
from pico.motion.engine import add_solids
from pico.motion.hulls import Hull, Placed, distance, of_geometry
from pico.motion.kinematics import Column, column_of, fk, joint_at, planar
from pico.motion.moves import legs, turned
from pico.motion.paths import heights, travel
from pico.motion.reach import check_grip, check_table, grasp_height
from pico.motion.recheck import Recheck, Task
from pico.motion.scene import FREE, Scene, within_reach
from pico.motion.stability import EDGE, check_stability
from pico.motion.sweep import Leg, march
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject
from pico.motion.xarm7 import LIMITS
from pico.motion.zones import HAND, WIDTHS, _clipped, _shadow, shared_zones

GANTRY = Robot(model="gantry", mount=Mount(x=0, y=0), speed=1.0)
ASKEW = Column(0.3, 0.2, 2000.0, 0, 172.0)
"""A column that is out of reach."""


# A gantry.


def gone(way: float, speed: float, t: float) -> tuple[float, float]:
    """Return how long a way takes at up to `speed` m/s, and how far it is at `t`: speeding up by 4 speed^2 m/s2."""
    a = 4.0 * speed**2
    ramp = min(speed / a, math.sqrt(way / a))
    top = a * ramp
    total = 2 * ramp + (way - top * ramp) / top
    if t <= ramp:
        return total, a * t * t / 2
    if t >= total - ramp:
        return total, way - a * (total - t) ** 2 / 2
    return total, top * ramp / 2 + top * (t - ramp)


@pytest.mark.parametrize("speed", [1.0, 0.5, 0.2])
@pytest.mark.parametrize("goal", [(0.7, 0.4, 0.3, 0.2), (0.3, 0.25, 0.22, 0.1), (0.3, 0.2, 0.25, 2.6)])
def test_a_gantry_speeds_up_goes_on_and_slows_down_on_a_straight_line(speed: float, goal: Joints) -> None:
    start = (0.3, 0.2, 0.25, 0.1)
    robot = replace(GANTRY, speed=speed)
    way = max(math.dist(start[:3], goal[:3]), 0.3 * abs(goal[3] - start[3]))
    parked = gantry.park(bench(robots={"g": robot}).lab, "g", start, {})
    assert isinstance(parked, MovePath)
    segment = parked.segments[0]
    assert (segment.joints[0], segment.opening) == (start, robot.gripper.stroke / 2)
    times, joints = gantry._straight(robot, start, goal)
    assert times[0] == 0.0 and times[-1] == pytest.approx(gone(way, speed, 0.0)[0])
    assert joints[-1] == pytest.approx(goal) and max(b - a for a, b in pairwise(times)) <= timing.PERIOD + 1e-9
    assert len(times) >= 3
    for t, now in zip(times, joints, strict=True):
        share = gone(way, speed, t)[1] / way
        assert now == pytest.approx([a + share * (b - a) for a, b in zip(start, goal, strict=True)], abs=1e-9)


def test_the_times_of_a_gantry_are_those_of_its_ways() -> None:
    robot = replace(GANTRY, speed=0.5, transit_height=250.0)
    a, b = Pose(100, 200, 10), Pose(700, 500, -60)

    def seconds(*stops: Joints) -> float:
        return sum(gantry._straight(robot, p, q)[0][-1] for p, q in pairwise(stops))

    def over(pose: Pose, yaw: float, z: float = 0.25) -> Joints:
        return (pose.x / 1000, pose.y / 1000, z, math.radians(pose.yaw + yaw))

    low, high = (0.3, 0.3, 0.1, 0.4), (0.3, 0.3, 0.25, 0.4)
    assert gantry.travel(robot, a, b, 90.0, 20.0) == pytest.approx(seconds(over(a, 90), over(b, 20)))
    assert gantry.travel(robot, low, b, 0.0, 20.0) == pytest.approx(seconds(low, high, over(b, 20)))
    assert gantry.travel(robot, None, b, 0.0, 20.0) == pytest.approx(seconds(robot.park_joints, over(b, 20)))
    assert gantry.travel(robot, a, None, 90.0, 0.0) == pytest.approx(seconds(over(a, 90), robot.park_joints))
    plumb = seconds(over(a, 0), over(a, 0, 0.1))
    assert gantry.carry(robot, a, b, 100.0, 0.7) == pytest.approx(4 * plumb + seconds(over(a, 0), over(b, 0)) + 1.4)
    assert gantry._straight(robot, low, low) == ((0.0, 0.0), (low, low))


# Kinematics and ways.


def test_right_over_its_shoulder_the_arm_has_no_posture() -> None:
    assert planar(76.0, 170.0) == ()
    assert len(planar(300.0, 300.0)) == 2 and planar(900.0, 300.0) == ()


def test_an_arm_stands_on_the_column_that_brings_it_there_and_on_none_where_it_leans() -> None:
    rng, found = random.Random(3), 0
    for _ in range(60):
        x, y, z = rng.uniform(150, 810), rng.uniform(150, 620), rng.uniform(80, 260)
        for joints in ik(ARM, x, y, z, rng.uniform(-180, 180)):
            column = column_of(ARM, joints)
            assert column is not None and column.at(z) == pytest.approx(joints, abs=1e-6)
            assert abs(abs(column.reach) - math.hypot(x - 480, y - 760)) < 1e-6
            for k in (2, 4, 5):
                lean = tuple(q + 0.0011 * (n == k) for n, q in enumerate(joints))
                assert column_of(ARM, lean) is None
            found += 1
    assert found > 100


def test_the_way_of_a_turn_is_bounded_and_not_by_much_more_than_the_arm_is_long() -> None:
    """The farthest that the tool, its side and the joints go is no farther than said, and at the longest lever arm what
    is said is no more than twice that."""
    rng = random.Random(4)
    worst = [0.0] * 7
    for _ in range(400):
        x, y, z = rng.uniform(150, 810), rng.uniform(150, 520), rng.uniform(80, 250)
        found = ik(ARM, x, y, z, rng.uniform(-180, 180))
        if not found:
            continue
        start = found[0]
        k, step = rng.randrange(7), rng.uniform(-0.02, 0.02)
        end = tuple(q + step * (n == k) for n, q in enumerate(start))
        (p, r), (q, s) = fk(start), fk(end)
        moves = [math.dist(p, q), *(math.dist(joint_at(start, n), joint_at(end, n)) for n in range(1, 8))]
        moves += [math.dist([p[i] + 60 * r[i][1] for i in range(3)], [q[i] + 60 * s[i][1] for i in range(3)])]
        said = travel(start, end)
        if k in (0, 1, 3, 6):
            assert max(moves) <= said + 1e-6, (k, moves, said)
        worst[k] = max(worst[k], max(moves) / said)
    assert min(worst[k] for k in (0, 1, 3)) > 0.4, worst
    assert travel(start, start) == 0.0


def test_joints_that_cancel_each_other_go_less_far() -> None:
    start = ik(ARM, 480, 300, 200, 0)[0]
    turn = lambda *d: travel(start, tuple(a + b for a, b in zip(start, d, strict=True)))  # noqa: E731
    assert turn(0, 0.1, 0, 0.1, 0, 0.0, 0) < turn(0, 0.1, 0, 0, 0, 0, 0) < turn(0, 0.1, 0, -0.1, 0, 0, 0)
    assert turn(0.1, 0, 0, 0, 0, 0, 0.1) < turn(0.1, 0, 0, 0, 0, 0, 0)
    assert turn(0, 0, 0.1, 0, 0, 0, 0) == pytest.approx(turn(0, 0, 0, 0, 0.1, 0, 0)) == pytest.approx(76.5)


def test_a_vertical_is_looked_at_every_ten_millimetres_from_above() -> None:
    assert heights(100, 125) == pytest.approx([125, 125 - 25 / 3, 125 - 50 / 3, 100])
    assert heights(100, 120) == [120, 110, 100] and heights(100, 100) == [100, 100]


def test_legs_rest_at_corners_and_go_straight_up_first() -> None:
    scene = Scene(bench(), "arm1", {PART: 1})
    low, high, far = (ik(ARM, x, 300, z, 0)[0] for x, z in ((400, 120), (400, 250), (600, 250)))
    times, joints = legs(scene, [low, high, far], 1)
    up, across = timing.vertical(ARM, column_of(ARM, low), 120.0, 250.0), timing.straight(ARM, high, far)
    assert times[-1] == pytest.approx(up[0][-1] + across[0][-1]) and len(times) == len(up[0]) + len(across[0]) - 1
    assert all(fk(q)[0][:2] == pytest.approx(fk(low)[0][:2], abs=1e-6) for q in joints[: len(up[0])])
    assert joints[len(up[0]) - 1] == pytest.approx(high, abs=1e-6) and joints[-1] == pytest.approx(far)
    assert list(times) == sorted(times) and legs(scene, [low], 0) == ((0.0, 0.0), (low, low))


def test_nothing_to_go_takes_no_time_and_what_is_out_of_reach_is_no_motion() -> None:
    joints = ik(ARM, 400, 300, 120, 0)[0]
    column = column_of(ARM, joints)
    assert (
        timing.straight(ARM, joints, joints) == ((0.0,), (joints,))
        and timing.swing_seconds(ARM, joints, joints, 0.0) == 0.0
    )
    assert timing.vertical(ARM, column, 120.0, 120.0)[0] == (0.0,)
    assert timing.vertical(ARM, column, 120.0, 120.0)[1][0] == pytest.approx(joints)
    assert timing.vertical_seconds(ARM, column, 120.0, 120.0) == 0.0
    with pytest.raises(ValueError, match="vertical at 100 mm"):
        timing.vertical(ARM, ASKEW, 100.0, 200.0)


@pytest.mark.parametrize(("speed", "tool_speed"), [(1.0, 1000.0), (0.3, 1000.0), (1.0, 250.0)])
def test_what_is_said_of_a_way_is_how_long_it_takes(speed: float, tool_speed: float) -> None:
    robot = replace(ARM, speed=speed, tool_speed=tool_speed)
    start, end = ik(robot, 400, 300, 120, 0)[0], ik(robot, 620, 420, 120, 30)[0]
    for share in (1.0, 0.2, 0.02):
        goal = tuple(a + share * (b - a) for a, b in zip(start, end, strict=True))
        longest = max(abs(a - b) for a, b in zip(start, goal, strict=True))
        said = timing.swing_seconds(robot, start, goal, longest)
        assert said == pytest.approx(timing.straight(robot, start, goal)[0][-1])
    column = column_of(robot, start)
    for low, high in ((120.0, 250.0), (250.0, 240.0), (120.0, 122.0)):
        assert timing.vertical_seconds(robot, column, low, high) == pytest.approx(
            timing.vertical(robot, column, low, high)[0][-1]
        )


def test_how_far_a_part_turns_counts_whole_turns() -> None:
    pick, place = Column(0.2, 0.5, 300.0, 0, 100.0), Column(0.7, -2.0, 300.0, 0, 100.0)
    assert turned(pick, place) == pytest.approx(math.degrees(0.5 + 2.5))
    assert turned(pick, replace(place, q7=place.q7 - 2 * math.pi)) == pytest.approx(math.degrees(3.0) + 360)


# What collides.


def hit_of(scene: Scene, joints: Joints) -> tuple[str, str, str] | None:
    hit = scene.look(joints)[1]
    return (hit.part, hit.obstacle, hit.kind) if hit else None


@pytest.mark.parametrize("held", [None, PART])
def test_both_checks_agree_on_where_the_arm_is_in_its_own_way(held: Geometry | None) -> None:
    """All over the ranges of the joints, above a table that is far away."""
    robot = replace(ARM, mount=Mount(x=480, y=760, yaw=-90, z=900))
    setup = bench(robots={"arm1": robot})
    scene, recheck, rng = Scene(setup, "arm1", {PART: 1}), Recheck(setup, "arm1"), random.Random(6)
    scene.open(34.0)
    scene.hold(held)
    here = Pose(0, 0)
    task = Task("a", held, here, here, 0.0) if held else Task()
    name = "transit" if held else "retreat"
    told, kinds = [], set()
    for _ in range(200):
        joints = tuple(rng.uniform(a, b) for a, b in LIMITS)
        slack, hit = scene.look(joints)
        path = MovePath("arm1", task.component, (Segment(name, (0.0, 0.0), (joints, joints), 34.0),))
        again = recheck.check(path, task, {}, {})
        if hit is not None:
            assert hit.kind == "self" and hit.missing == -hit.gap and hit.obstacle.startswith("arm1 ")
            kinds.add((hit.part == "held", hit.obstacle == "arm1 held"))
        if hit is not None and hit.gap < -1.0:
            assert again is not None and again.kind == "collision", (joints, hit)
            told.append(True)
        elif hit is None and slack > 0:
            assert again is None, joints
            told.append(False)
    assert min(told.count(True), told.count(False)) > 15
    assert (False, True) not in kinds and ((True, False) in kinds) is (held is not None), "what is held is named first"


def test_a_hit_on_itself_names_both_parts_and_how_deep() -> None:
    scene = Scene(bench(), "arm1", {PART: 2})
    folded = (-0.096, -1.644, -3.936, 0.036, 1.225, 2.604, -3.562)
    assert hit_of(scene, folded) == ("base", "arm1 gripper", "self")
    scene.hold(PART)
    over = (1.298, 0.904, -4.925, 0.653, 5.922, 2.708, -4.259)
    assert hit_of(scene, over) == ("held", "arm1 link2", "self")
    scene.hold(None)
    assert hit_of(scene, over) != ("held", "arm1 link2", "self")


def test_the_second_check_knows_where_the_table_and_its_zones_end() -> None:
    zone = KeepOut(area=Box2(x=(600, 640), y=(300, 360)), z=(100, 150))
    small = bench(keep_out={"lamp": zone})
    small = replace(small, lab=replace(small.lab, table=Table(size=(700, 900))))
    recheck = Recheck(small, "arm1")

    def at(x: float, y: float, z: float) -> str | None:
        """What the closed fingers meet; their tips are `tip` below the tool center point."""
        joints = ik(ARM, x, y, z, 90.0)[0]
        path = MovePath("arm1", None, (Segment("retreat", (0.0, 0.0), (joints, joints), 0.0),))
        found = recheck.check(path, Task(), {}, {})
        return found.obstacle if found else None

    tip, fingers = ARM.gripper.fingers.tip, ARM.gripper.fingers
    wide = max(fingers.breadth / 2, fingers.thickness)
    assert at(400, 300, tip - 1) == "table" and at(400, 300, tip + 1) is None
    assert at(700 + wide + 2, 300, tip - 5) is None and at(700 + 2, 300, tip - 5) == "table"
    for x, y, z, hit in (
        (620, 330, 150 + tip + 1, False), (620, 330, 150 + tip - 1, True),
        (640 + wide + 1, 330, 150 + tip - 20, False), (642, 330, 150 + tip - 20, True),
        (620, 300 - wide - 1, 150 + tip - 20, False), (620, 298, 150 + tip - 20, True),
    ):  # fmt: skip
        assert (at(x, y, z) == "lamp") is hit, (x, y, z)


def test_what_stands_within_reach_is_what_an_arm_could_touch() -> None:
    setup = bench()
    things = stands(at={"near": (DISC, Pose(480, 760 - 100)), "edge": (DISC, Pose(480 + 600 + 25, 760)),
                        "far": (DISC, Pose(480 + 600 + 26, 760))})  # fmt: skip
    assert set(within_reach(setup, "arm1", things, 600.001)) == {"near", "edge"}
    assert set(within_reach(setup, "arm1", things, 600.0)) == {"near"}


def test_what_a_held_part_could_touch_beyond_the_arm_is_looked_at() -> None:
    motion = ArmMotion(bench())
    far = {"t": StandingObject(Pose(480, 760 - ARM_REACH - 25 - 60), DISC)}
    assert not motion._near("arm1", far, None) and not motion._near("arm1", far, DISC)
    assert motion._near("arm1", far, replace(PART, footprint=Footprint(disc=61)))


HULLS = (
    Hull("a", "box", (0.03, 0.02, 0.05), np.zeros(3), np.eye(3)),
    Hull("a", "cylinder", (0.02, 0.02, 0.06), np.zeros(3), np.eye(3)),
    Hull("a", "capsule", (0.02, 0.0, 0.06), np.zeros(3), np.eye(3)),
    of_geometry("a", TRIANGLE)[0],
    of_geometry("a", replace(TRIANGLE, footprint=Footprint(polygon=((0, -30), (60, 0), (10, 50), (-20, 10)))))[0],
)
ROUND = of_geometry("a", replace(TRIANGLE, footprint=Footprint(polygon=tuple(
    (40 * math.cos(t), 40 * math.sin(t)) for t in np.linspace(0, 2 * math.pi, 24, endpoint=False).tolist()
))))[0]  # fmt: skip
"""A prism of so many corners that its nearest one is looked for along its edges."""


def points_of(hull: Hull) -> np.ndarray:
    """Points all over the surface of a hull that is at the origin [m]."""
    a, b, c = hull.half
    if hull.kind == "prism":
        return np.array(hull.corners)
    if hull.kind == "box":
        return np.array([(x * a, y * b, z * c) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    angles = np.linspace(0, 2 * math.pi, 181)
    rim = np.column_stack((a * np.cos(angles), a * np.sin(angles), 0 * angles))
    if hull.kind == "cylinder":
        return np.concatenate((rim + np.array((0, 0, c)), rim - np.array((0, 0, c))))
    tilts = np.linspace(0, math.pi / 2, 61)
    cap = np.array([(a * math.cos(t) * math.cos(f), a * math.cos(t) * math.sin(f), a * math.sin(t))
                    for t in tilts for f in angles])  # fmt: skip
    return np.concatenate((cap + np.array((0, 0, c)), cap * (1, 1, -1) - np.array((0, 0, c))))


@pytest.mark.parametrize("hull", HULLS, ids=lambda hull: hull.kind)
def test_a_hull_reaches_as_far_as_its_points_do(hull: Hull) -> None:
    points, rng = points_of(hull), np.random.default_rng(1)
    assert hull.radius >= np.linalg.norm(points, axis=1).max() - 1e-12
    assert hull.kind == "prism" or hull.radius == pytest.approx(np.linalg.norm(points, axis=1).max())
    for _ in range(20):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        n = turn[:, 0]
        assert hull.support(n.tolist()) == pytest.approx((points @ n).max(), abs=2e-5)
        reach = np.abs(points @ turn.T).max(axis=0)
        assert np.all(hull.extent(turn) >= reach - 1e-9)
        if hull.kind != "prism":
            assert hull.extent(turn) == pytest.approx(reach, abs=2e-5)


@pytest.mark.parametrize("one", HULLS, ids=lambda hull: hull.kind)
@pytest.mark.parametrize("other", HULLS, ids=lambda hull: hull.kind)
def test_hulls_are_as_far_apart_as_their_points_say(one: Hull, other: Hull) -> None:
    """Apart along a direction in which both end: the distance is known; and where they overlap there is none."""
    for axis in np.eye(3)[2:] if "prism" in (one.kind, other.kind) else np.eye(3):
        reach = one.support(axis.tolist()) + other.support((-axis).tolist())
        for gap in (0.0005, 0.02):
            there = Placed(other).put(np.eye(3), (reach + gap) * axis)
            assert distance(Placed(one), there, 1.0) == pytest.approx(gap, abs=5e-5)
        assert distance(Placed(one), Placed(other).put(np.eye(3), (reach - 0.001) * axis), 1.0) == 0.0


@pytest.mark.parametrize("other", [*HULLS[:3], ROUND], ids=lambda hull: hull.kind)
def test_a_prism_of_many_corners_ends_at_them(other: Hull) -> None:
    for axis in (*np.eye(3), *-np.eye(3)):
        reach = ROUND.support(axis.tolist()) + other.support((-axis).tolist())
        for gap in (0.0005, 0.02):
            there = Placed(other).put(np.eye(3), (reach + gap) * axis)
            assert distance(Placed(ROUND), there, 1.0) == pytest.approx(gap, abs=5e-5)


@pytest.mark.parametrize(("axis", "yaw", "along"), [("x", 0, (1, 0, 0)), ("y", 0, (0, 1, 0)), ("z", 40, (0, 0, 1)),
                                                    ("x", 90, (0, 1, 0)), ("y", 30, (-0.5, 0.75**0.5, 0))])  # fmt: skip
def test_a_cylinder_lies_as_it_is_said_to(axis: str, yaw: float, along: tuple[float, ...]) -> None:
    """In both checks: its length of 90 mm reaches along its axis, its radius of 12 across."""
    body = Body(name="b", shape="cylinder", size=(24, 90), at=(5, -8, 60), axis=axis, yaw=yaw)
    geometry = Geometry(footprint=Footprint(box=(100, 100)), height=120, mass=0.2, bodies=(body,))
    spec = mujoco.MjSpec()
    add_solids(spec, spec.worldbody.add_body(name="part"), geometry)
    geom = (model := spec.compile()).geom(0)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    assert data.geom_xpos[0] == pytest.approx((0.005, -0.008, 0.06))
    assert geom.size[:2] == pytest.approx((0.012, 0.045))
    assert abs(data.geom_xmat[0].reshape(3, 3)[:, 2] @ along) == pytest.approx(1)
    (hull,) = of_geometry("a", geometry)
    assert hull.half == pytest.approx((0.012, 0.012, 0.045)) and hull.center == pytest.approx((0.005, -0.008, 0.06))
    assert abs(hull.turn[:, 2] @ along) == pytest.approx(1) and np.linalg.det(hull.turn) == pytest.approx(1)


def test_a_box_is_turned_as_it_is_said_to() -> None:
    body = Body(name="b", shape="box", size=(80, 20, 40), at=(5, -8, 60), yaw=30)
    geometry = Geometry(footprint=Footprint(box=(100, 100)), height=120, mass=0.2, bodies=(body,))
    (hull,) = of_geometry("a", geometry, 0.001)
    assert hull.half == pytest.approx((0.039, 0.009, 0.019))
    assert hull.turn == pytest.approx(frames.about_z(math.radians(30)))


def test_an_arm_that_goes_home_finds_the_other_where_it_stands() -> None:
    """With both bases near one another the way home of one is through the other, where that reaches out."""
    near = replace(ARM, mount=Mount(x=700, y=760, yaw=-90))
    motion = ArmMotion(bench(robots={"arm1": ARM, "arm2": near}), second_check=False)
    mine = ik(ARM, 780, 420, 250, 0)[0]
    free, struck = (
        motion.park("arm1", mine, {}, {"arm2": ik(near, x, y, 250, 0)[0]}) for x, y in ((1100, 500), (560, 480))
    )
    assert isinstance(free, MovePath), free
    assert isinstance(struck, Blocked) and (struck.obstacle, struck.segment) == ("arm2", "park")


def test_what_nobody_can_hold_is_never_carried_and_a_cup_only_settles() -> None:
    setup = bench()
    part = replace(setup.catalog["part"], geometry=replace(PART, grasp=None))
    bare = ArmMotion(replace(setup, catalog={**setup.catalog, "part": part}))
    assert bare.carry("arm1", "a", Pose(290, 300), Pose(620, 420), 0.0) == math.inf
    assert bare.carry("arm1", "disc", Pose(290, 300), Pose(620, 420), 0.0) < 60
    cup = replace(ARM, gripper=Gripper(fingers="none"))
    assert timing.grip_seconds(cup, PART) == timing.JAW_SETTLE == timing.grip_seconds(ARM, replace(PART, grasp=None))
    opens = ARM.gripper.fingers.opening
    assert timing.grip_seconds(ARM, PART) == pytest.approx(2 * opens / 100 + 0.2)


def test_what_a_hull_sweeps_is_how_far_its_center_goes_and_how_far_the_turn_carries_its_farthest_point() -> None:
    flat = Hull("link", "box", (0.3, 0.4, 1e-9), np.array((0.1, 0.0, 0.0)), np.eye(3))
    angles = np.array((0.0, 0.1, 0.4, 0.4))
    turns = np.tile(np.eye(3), (4, 10, 1, 1))
    turns[:, 3] = frames.about_z(angles)
    origins = np.zeros((4, 10, 3))
    origins[3, :, 2] = 0.25
    leg = Leg([(3, flat)], turns, origins)
    chords = 2 * np.sin(np.diff(angles) / 2)
    assert leg.covered(0) == pytest.approx([0.0, *np.cumsum([*(0.6 * chords[:2]), 0.25])])
    _, low, high = leg.boxes(0)
    corners = np.array([(0.1 + 0.3 * x, 0.4 * y, 0.0) for x in (-1, 1) for y in (-1, 1)]) @ frames.about_z(0.4).T
    assert low[2] == pytest.approx(corners.min(axis=0), abs=1e-8)
    assert high[2] == pytest.approx(corners.max(axis=0), abs=1e-8)
    floor, ceiling = high[3] + 0.1, high[3] + 0.2
    assert leg.near(0, floor, ceiling, 0.09).tolist() == [False, False, False, False]
    assert leg.near(0, floor, ceiling, 0.11).tolist() == [False, False, False, True]


def test_a_march_measures_again_only_where_the_last_measure_does_not_reach() -> None:
    gaps = [0.5, 0.9, 0.4, 0.05, 0.2]
    asked: list[int] = []

    def measure(i: int, enough: float) -> float:
        asked.append(i)
        assert enough == pytest.approx(0.1)
        return gaps[i]

    everywhere, way = np.ones(5, dtype=bool), np.array((0.0, 0.3, 0.4, 0.41, 0.7))
    assert march(everywhere, way, 0.1, measure) == 0.05 and asked == [0, 3]
    assert march(everywhere, way * 0.5, 0.1, lambda i, _: gaps[i]) is None
    assert march(np.array((1, 0, 0, 0, 1), dtype=bool), way, 0.1, lambda i, _: gaps[i]) is None
    assert march(everywhere, way, 0.0, lambda *_: 0.0) == 0.0 and march(~everywhere, way, 9.0, measure) is None


# Where arms meet.


def test_two_circles_of_reach_meet_in_their_overlap() -> None:
    rng = random.Random(9)
    for _ in range(40):
        table = ((0.0, 0.0), (1000.0, 0.0), (1000.0, 700.0), (0.0, 700.0))
        center, radius = (rng.uniform(-400, 1400), rng.uniform(-400, 1100)), rng.uniform(100, 900)
        wide = radius / math.cos(math.pi / 48)
        turns = [(2 * i + 1) * math.pi / 48 for i in range(48)]
        around = Polygon([(center[0] + wide * math.cos(t), center[1] + wide * math.sin(t)) for t in turns])
        want = shapely.intersection(Polygon(table), around)
        found = _clipped(table, center, radius)
        if want.area < 1e-6:
            assert len(found) < 3 or Polygon(found).area < 1e-6
        else:
            assert shapely.symmetric_difference(Polygon(found), want).area < 1e-3
            assert Polygon(found).exterior.is_ccw


def test_the_shadow_of_an_arm_begins_at_its_base_and_ends_with_its_hand() -> None:
    joints = ik(ARM, 620, 420, 150, 20)[0]
    shadow = list(_shadow(ARM, joints, HAND))
    assert (shadow[0].x, shadow[0].y) == pytest.approx((480, 760), abs=1e-9)
    assert (shadow[-1].x, shadow[-1].y, shadow[-1].radius) == pytest.approx((620, 420, HAND), abs=1e-6)
    assert {d.radius for d in shadow[:-1]} == set(WIDTHS)
    assert all(math.dist((a.x, a.y), (b.x, b.y)) <= 60 for a, b in pairwise(shadow))
    for k in (4, 6, 7):
        x, y, _ = joint_at(joints, k)
        assert min(math.dist((480 + y, 760 - x), (d.x, d.y)) for d in shadow) < 1e-6


def test_a_gantry_shares_the_reach_of_an_arm_with_it_and_all_of_the_table_with_another() -> None:
    both = bench(robots={"g": GANTRY, "h": GANTRY})
    (zone,) = shared_zones(both)
    assert (zone.name, zone.corners) == ("zone/g+h", ((0, 0), (1200, 0), (1200, 900), (0, 900)))
    (mixed,) = shared_zones(bench(robots={"g": GANTRY, "arm1": ARM}))
    area = Polygon(mixed.corners)
    assert mixed.robots == ("arm1", "g") and area.contains(Point(480, 300)) and not area.contains(Point(1190, 10))


# What stands.


def block(*bodies: Body, mass: float = 0.3, height: float = 100.0, grasp: float = 60.0) -> Geometry:
    return Geometry(footprint=Footprint(box=(120, 120)), height=height, mass=mass, bodies=bodies,
                    grasp=Grasp(height=grasp, width=20))  # fmt: skip


@pytest.mark.parametrize(("axis", "yaw"), [("x", 0), ("y", 0), ("x", 30)])
def test_a_cylinder_that_lies_stands_on_a_line(axis: str, yaw: float) -> None:
    """Alone it would roll; beside a block its line widens what both stand on, and only along itself."""
    lying = Body(name="roll", shape="cylinder", size=(20, 80), at=(0, 0, 10), axis=axis, yaw=yaw)
    along = math.radians(yaw + (90 if axis == "y" else 0))
    assert check_stability("a", block(lying)) is None, "a line alone is no base: its footprint is"
    foot = Body(name="foot", shape="box", size=(8, 8, 10), at=(0, 0, 5), yaw=yaw)
    for off, stable in ((25.0, True), (110.0, False)):  # what stands above has 0.4 of the mass
        x, y = off * math.cos(along), off * math.sin(along)
        top = Body(name="top", shape="box", size=(8, 8, 20), at=(x, y, 12))
        found = check_stability("a", block(lying, foot, top))
        assert (found is None) is stable, found
        across = check_stability("a", block(lying, foot, replace(top, at=(-y, x, 12))))
        assert across is not None and "outside" in across.text


def test_the_edge_is_as_far_as_is_said() -> None:
    foot = Body(name="foot", shape="box", size=(40, 40, 10), at=(0, 0, 5))
    for x, says in ((10.0, None), (18.0, "only 2 mm from the edge of"), (25.0, "5 mm outside")):
        top = Body(name="top", shape="box", size=(10, 10, 10), at=(x / 0.4, 0, 15))
        found = check_stability("a", block(foot, top))
        assert says in found.text if found else says is None, found
        assert found is None or found.by == pytest.approx(EDGE - (20 - x))


def test_a_part_without_a_grasp_has_no_height_to_be_held_at() -> None:
    bare = replace(PART, grasp=None)
    with pytest.raises(ValueError, match="no grasp"):
        grasp_height(ARM, bare)
    held = check_grip("arm1", ARM, "a", bare)
    assert held is not None and "no place where a gripper may hold it" in held.text
    cup = replace(ARM, gripper=Gripper(fingers="none"))
    assert (grasp_height(cup, PART), grasp_height(ARM, PART)) == (140, 100)


def test_beside_a_zone_and_at_the_edge_of_the_table_there_is_room_to_the_last_millimetre() -> None:
    lab = bench(keep_out={"lamp": KeepOut(area=Box2(x=(600, 700), y=(300, 400)), z=(0, 50))}).lab
    assert check_table(lab, "a", PART, Pose(569.5, 350)) is None
    inside = check_table(lab, "a", PART, Pose(570.5, 350))
    assert isinstance(inside, Blocked) and inside.by == pytest.approx(0.5)
    assert check_table(lab, "a", PART, Pose(30, 30)) is None and check_table(lab, "a", PART, Pose(1170, 870)) is None
    over = check_table(lab, "a", PART, Pose(29.5, 30))
    assert over is not None and (over.kind, over.by) == ("table_edge", pytest.approx(0.5))


def test_free_space_is_told_up_to_a_limit() -> None:
    scene = Scene(bench(), "arm1", {TALL: 1})
    scene.open(50.0)
    assert scene.look(ik(ARM, 480, 300, 250, 0)[0]) == (FREE, None)
