"""A gantry: reaches every place of its table from above, and collides with what stands at the goal and with what is
taller than it carries.

Its joints are x, y, z of the tool center point [m] and its yaw [rad] in the table frame.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

from pico.geometry.around import Load, way
from pico.geometry.shape import disc, placed, polygon, separation
from pico.model.catalog import Geometry
from pico.model.lab import Lab
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.motion import timing
from pico.motion.reach import grasp_height, opening
from pico.motion.types import Blocked, Joints, MovePath, Segment, SegmentName, StandingObject

SPEED, ACCELERATION = 1.0, 4.0  # m/s, m/s2 at full speed; a turn of 1 rad counts as 0.3 m
_ARM = 0.3
CUP = 20.0
"""Radius of what a vacuum gripper sucks with [mm]."""


def move(
    lab: Lab,
    name: str,
    component: str,
    geometry: Geometry,
    start: Pose,
    goal: Pose,
    grasp_yaw: float,
    standing: Mapping[str, StandingObject],
    joints: Joints,
) -> MovePath | Blocked:
    """Return the way over the top, around what is taller; blocked where there is none, and where the footprint at
    `goal` overlaps another."""
    robot, others = lab.robots[name], {n: t for n, t in standing.items() if n != component}
    if struck := overlapped(component, geometry, goal, others):
        return struck
    assert geometry.grasp is not None  # the caller asked `check_grip`
    width, opened = geometry.grasp.width, opening(robot, geometry)
    high, low = robot.transit_height / 1000, grasp_height(robot, geometry) / 1000
    over_start, at_start = (_at(start, grasp_yaw, z) for z in (high, low))
    over_goal, at_goal = (_at(goal, grasp_yaw, z) for z in (high, low))
    jaws = timing.jaw_seconds(opened, width)
    coming = _over(lab, name, joints, over_start, hand(lab, robot, opened), standing, component)
    carried = Load(lambda at: placed(geometry.footprint, Pose(*at)), geometry.footprint.radius, lab.margins.body)
    foot = robot.transit_height - grasp_height(robot, geometry)
    tall = {n: t for n, t in others.items() if t.geometry.height > foot - lab.margins.body}
    shapes = {n: placed(t.geometry.footprint, t.pose) for n, t in tall.items()}
    transit = way(carried, shapes, (start.x, start.y, start.yaw), (goal.x, goal.y, goal.yaw), lab.table.size)
    if isinstance(coming, Blocked):
        return coming
    if isinstance(transit, str):
        height = standing[transit].geometry.height
        text = (
            f"{component}, carried with its foot at {foot:.4g} mm, would hit {transit}, which is {height:.4g} mm tall, "
            f"on every way from {start} to {goal}"
        )
        return Blocked("collision", text, "transit", transit, None, _higher(robot, transit, height - foot, lab))
    legs = [(x / 1000, y / 1000, high, math.radians(yaw + grasp_yaw)) for x, y, yaw in transit]
    segments = (
        Segment("approach", *coming, opened),
        Segment("descend", *_straight(robot, over_start, at_start), opened),
        Segment("grip", (0.0, jaws), (at_start, at_start), width),
        Segment("lift", *_straight(robot, at_start, over_start), width),
        Segment("transit", *_chained(robot, legs), width),
        Segment("lower", *_straight(robot, over_goal, at_goal), width),
        Segment("release", (0.0, jaws), (at_goal, at_goal), opened),
        Segment("retreat", *_straight(robot, at_goal, over_goal), opened),
    )
    return MovePath(name, component, segments)


def overlapped(component: str, geometry: Geometry, goal: Pose, others: Mapping[str, StandingObject]) -> Blocked | None:
    """Return what a part would be set down on."""
    shape = placed(geometry.footprint, goal)
    near = [n for n, t in others.items() if goal.distance(t.pose) < shape.radius + t.geometry.footprint.radius]
    for other in sorted(near):
        gap = separation(shape, placed(others[other].geometry.footprint, others[other].pose))
        if gap < 0:
            text = f"{component} would hit {other} by {-gap:.1f} mm, setting it down at {goal}"
            return Blocked("collision", text, "lower", other, round(-gap, 3))
    return None


def park(lab: Lab, name: str, joints: Joints, standing: Mapping[str, StandingObject]) -> MovePath | Blocked:
    """Return the way to where the gantry waits: straight up, then over there."""
    robot = lab.robots[name]
    opened = robot.gripper.stroke / 2
    found = _over(lab, name, joints, robot.park_joints, hand(lab, robot, opened), standing, None)
    return found if isinstance(found, Blocked) else MovePath(name, None, (Segment("park", *found, opened),))


def hand(lab: Lab, robot: Robot, opened: float) -> Load:
    """Return the empty hand as a load: both fingers, `opened` so far, and what is between them."""
    fingers = robot.gripper.fingers
    if fingers == "none":
        return Load(lambda at: disc(at[0], at[1], CUP), CUP, lab.margins.fingers)
    x, y = opened / 2 + fingers.thickness, fingers.breadth / 2
    corners = ((-x, -y), (x, -y), (x, y), (-x, y))
    return Load(lambda at: polygon(tuple(Pose(*at).apply(*c) for c in corners)), math.hypot(x, y), lab.margins.fingers)


def _over(
    lab: Lab, name: str, joints: Joints, goal: Joints, load: Load, standing: Mapping[str, StandingObject],
    component: str | None,
) -> timing.Timed | Blocked:  # fmt: skip
    """Return the way of the empty hand up to transit height, and then to above a place."""
    robot = lab.robots[name]
    fingers = robot.gripper.fingers
    tip = robot.transit_height - lab.margins.fingers - (0.0 if fingers == "none" else fingers.tip)
    tall = {n: placed(t.geometry.footprint, t.pose) for n, t in standing.items() if t.geometry.height > tip + 1e-6}
    risen = (joints[0], joints[1], max(joints[2], robot.transit_height / 1000), joints[3])
    found = way(load, tall, _seen_from_above(risen), _seen_from_above(goal), lab.table.size) if tall else None
    if isinstance(found, str):
        height = standing[found].geometry.height
        doing = f"on its way to {component}" if component else "on its way to its park pose"
        text = f"{name}'s hand would hit {found}, which is {height:.4g} mm tall, on every way, {doing}"
        segment: SegmentName = "approach" if component else "park"
        return Blocked("collision", text, segment, found, None, _higher(robot, found, height - tip, lab))
    corners = [(x / 1000, y / 1000, risen[2], math.radians(yaw)) for x, y, yaw in found[1:-1]] if found else []
    return _chained(robot, [joints, risen, *corners, goal])


def _higher(robot: Robot, obstacle: str, lacking: float, lab: Lab) -> str:
    high = math.ceil(robot.transit_height + lacking + lab.margins.body + 1e-6)
    return f"move {obstacle} away first, or carry higher (`transit_height: {high}`)"


def _seen_from_above(joints: Joints) -> tuple[float, float, float]:
    return 1000 * joints[0], 1000 * joints[1], math.degrees(joints[3])


def _chained(robot: Robot, corners: Sequence[Joints]) -> timing.Timed:
    """The straight lines from corner to corner, resting at each."""
    times, points = [0.0], [corners[0]]
    for a, b in pairwise(corners):
        more, line = _straight(robot, a, b)
        if len(corners) == 2 or more[-1] > 0:
            times += [times[-1] + t for t in more[1:]]
            points += line[1:]
    if len(times) == 1:
        return (0.0, 0.0), (corners[0], corners[-1])
    return tuple(times), tuple(points)


def travel(robot: Robot, start: Pose | Joints | None, goal: Pose | None, start_yaw: float, goal_yaw: float) -> float:
    """Return the seconds from above one place to above another; see `Motion.travel`."""
    high, rise = robot.transit_height / 1000, 0.0
    if isinstance(start, Pose):
        above = _at(start, start_yaw, high)
    else:
        joints = start or robot.park_joints
        above = (joints[0], joints[1], max(joints[2], high), joints[3])
        rise = _seconds(robot, joints, above)
    return rise + _seconds(robot, above, _at(goal, goal_yaw, high) if goal else robot.park_joints)


def carry(robot: Robot, start: Pose, goal: Pose, low: float, jaws: float) -> float:
    """Return the seconds from above one place, held at `low` [mm], to above another; see `Motion.carry`."""
    high = robot.transit_height / 1000
    plumb = _seconds(robot, _at(start, 0.0, high), _at(start, 0.0, low / 1000))
    return 4 * plumb + _seconds(robot, _at(start, 0.0, high), _at(goal, 0.0, high)) + 2 * jaws


def _seconds(robot: Robot, start: Joints, end: Joints) -> float:
    way, peak, ramp = _ramps(robot, start, end)
    return way / peak + ramp if way >= 1e-9 else 0.0


def _ramps(robot: Robot, start: Joints, end: Joints) -> tuple[float, float, float]:
    """How far it is [m], how fast the gantry gets [m/s], and how long that takes [s]."""
    way = max(math.dist(start[:3], end[:3]), _ARM * abs(end[3] - start[3]))
    acceleration = ACCELERATION * robot.speed**2
    peak = min(SPEED * robot.speed, robot.fastest / 1000, math.sqrt(acceleration * way))
    return way, peak, peak / acceleration


def _at(pose: Pose, grasp_yaw: float, z: float) -> Joints:
    return pose.x / 1000, pose.y / 1000, z, math.radians(pose.yaw + grasp_yaw)


def _straight(robot: Robot, start: Joints, end: Joints) -> timing.Timed:
    """A trapezoid of speed along the straight line, as waypoints; a triangle where the way is short."""
    way, peak, ramp = _ramps(robot, start, end)
    if way < 1e-9:
        return (0.0, 0.0), (start, end)
    acceleration = ACCELERATION * robot.speed**2
    seconds = way / peak + ramp
    count = max(2, math.ceil(seconds / timing.PERIOD))
    times = tuple(seconds * i / count for i in range(count + 1))

    def gone(t: float) -> float:
        if t < ramp:
            return acceleration * t * t / 2
        if t > seconds - ramp:
            return way - acceleration * (seconds - t) ** 2 / 2
        return peak * (t - ramp / 2)

    shares = (gone(t) / way for t in times)
    return times, tuple(tuple(a + s * (b - a) for a, b in zip(start, end, strict=True)) for s in shares)
