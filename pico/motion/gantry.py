"""A gantry: reaches every place of its table from above and collides with nothing but what stands at the goal.

Its joints are x, y, z of the tool center point [m] and its yaw [rad] in the table frame.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.geometry.shape import placed, separation
from pico.model.catalog import Geometry
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.motion import timing
from pico.motion.reach import grasp_height, opening
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject

SPEED, ACCELERATION = 1.0, 4.0  # m/s, m/s2 at full speed; a turn of 1 rad counts as 0.3 m
_ARM = 0.3


def move(
    name: str,
    robot: Robot,
    component: str,
    geometry: Geometry,
    start: Pose,
    goal: Pose,
    grasp_yaw: float,
    standing: Mapping[str, StandingObject],
    joints: Joints,
) -> MovePath | Blocked:
    """Return the way over the top; blocked where the footprint at `goal` overlaps another."""
    shape = placed(geometry.footprint, goal)
    near = [n for n, t in standing.items() if goal.distance(t.pose) < shape.radius + t.geometry.footprint.radius]
    for other in sorted(near):
        gap = separation(shape, placed(standing[other].geometry.footprint, standing[other].pose))
        if other != component and gap < 0:
            text = f"{component} would hit {other} by {-gap:.1f} mm, setting it down at {goal}"
            return Blocked("collision", text, "lower", other, round(-gap, 3))
    assert geometry.grasp is not None  # the caller asked `check_grip`
    width, opened = geometry.grasp.width, opening(robot, geometry)
    high, low = robot.transit_height / 1000, grasp_height(robot, geometry) / 1000
    over_start, at_start = (_at(start, grasp_yaw, z) for z in (high, low))
    over_goal, at_goal = (_at(goal, grasp_yaw, z) for z in (high, low))
    jaws = timing.jaw_seconds(opened, width)
    risen = (joints[0], joints[1], max(joints[2], high), joints[3])
    first, second = _straight(robot, joints, risen), _straight(robot, risen, over_start)
    approach = (*first[0], *(first[0][-1] + t for t in second[0][1:])), (*first[1], *second[1][1:])
    segments = (
        Segment("approach", *approach, opened),
        Segment("descend", *_straight(robot, over_start, at_start), opened),
        Segment("grip", (0.0, jaws), (at_start, at_start), width),
        Segment("lift", *_straight(robot, at_start, over_start), width),
        Segment("transit", *_straight(robot, over_start, over_goal), width),
        Segment("lower", *_straight(robot, over_goal, at_goal), width),
        Segment("release", (0.0, jaws), (at_goal, at_goal), opened),
        Segment("retreat", *_straight(robot, at_goal, over_goal), opened),
    )
    return MovePath(name, component, segments)


def park(name: str, robot: Robot, joints: Joints) -> MovePath:
    """Return the way to where the gantry waits."""
    segment = Segment("park", *_straight(robot, joints, robot.park_joints), robot.gripper.stroke / 2)
    return MovePath(name, None, (segment,))


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
