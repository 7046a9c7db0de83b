"""How long a path takes: rest to rest along one path parameter, within the limits of every joint.

A straight line in joint space is s -> a + s (b - a), so that all joints start, cruise and stop together; a vertical is
z -> joints. Ruckig finds the time-optimal s(t) for the limits that the joints leave to s. It is never given waypoints
in between: the free version would ask a server on the internet for them.

Robot.speed scales velocity; acceleration goes with its square and jerk with its cube, so that half the speed takes
twice the time along the same profile. The tool center point is never faster than Robot.tool_speed, whatever the joints
may do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any

from pico.model.catalog import Geometry
from pico.model.robot import TOOL_SPEED, Robot
from pico.motion.kinematics import Column, pace
from pico.motion.reach import opening
from pico.motion.types import Joints
from pico.motion.xarm7 import JOINT_ACCELERATION, JOINT_JERK, JOINT_SPEED

Timed = tuple[tuple[float, ...], tuple[Joints, ...]]
"""Times [s] from 0, and the joints [rad] at each."""

PERIOD = 0.02
"""Greatest time between two waypoints of a timed path [s]."""
JAW_SPEED = 100.0
"""How fast the opening of the gripper changes [mm/s]."""
STEADY = 0.2
"""How long an arm stands still until it is where it should be, and something was looked at [s]."""
CORRECTING = 0.5
"""How long it takes just over the table to come to rest, to be looked at, and to be let down where it belongs [s]."""
JAW_SETTLE = 0.2
"""How long a grip takes to set, or a part to stand [s]."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Greatest velocity, acceleration and jerk; of a joint in rad, else in units of the path parameter."""

    velocity: float
    acceleration: float
    jerk: float

    def scaled(self, factor: float) -> Limits:
        """Return the limits that make the same motion last 1/`factor` times as long."""
        return Limits(self.velocity * factor, self.acceleration * factor**2, self.jerk * factor**3)


def joint_limits(robot: Robot) -> Limits:
    """Return what a joint of `robot` may do at its speed setting."""
    return Limits(JOINT_SPEED, JOINT_ACCELERATION, JOINT_JERK).scaled(robot.speed)


def straight(robot: Robot, start: Joints, end: Joints) -> Timed:
    """Return the fastest motion along the straight line in joint space, all joints in phase, that keeps the limits of
    the joints and of the tool."""
    delta = tuple(b - a for a, b in zip(start, end, strict=True))
    longest = max(abs(d) for d in delta)
    if longest < 1e-9:
        return (0.0,), (start,)
    limits = _swing_limits(robot, start, end, longest)
    times, shares = profile(
        1.0, Limits(limits.velocity / longest, limits.acceleration / longest, limits.jerk / longest)
    )
    return times, tuple(tuple(a + s * d for a, d in zip(start, delta, strict=True)) for s in shares)


def vertical(robot: Robot, column: Column, start: float, end: float) -> Timed:
    """Return the motion of the tool straight up or down `column` from height `start` to `end` [mm].

    The bound is that of the steepest place on the way, so it is somewhat slower than it could be. Raises ValueError
    where the column leaves the arm's limits.
    """
    length, sign = abs(end - start), math.copysign(1.0, end - start)
    if length < 1e-6:
        return (0.0,), (_at(column, start),)
    times, ways = profile(length, _vertical_limits(robot, column, start, end))
    return times, tuple(_at(column, start + sign * way) for way in ways)


def steady(way: Timed, seconds: float = STEADY) -> Timed:
    """Return a motion after which the arm stands still for a time [s]."""
    times, joints = way
    return (*times, times[-1] + seconds), (*joints, joints[-1])


def jaw_seconds(opening: float, width: float) -> float:
    """Return how long the gripper takes to close from `opening` on a part of `width` [mm], or to open again."""
    return abs(opening - width) / JAW_SPEED + JAW_SETTLE


def grip_seconds(robot: Robot, geometry: Geometry) -> float:
    """Return how long the hand of an arm takes to close on a part, or to let it go [s]; a suction cup only settles."""
    if robot.gripper.fingers == "none" or geometry.grasp is None:
        return JAW_SETTLE
    return jaw_seconds(opening(robot, geometry), geometry.grasp.width)


def profile(length: float, limits: Limits) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return times [s] and ways of the time-optimal motion from 0 to `length`, at rest at both ends."""
    import ruckig

    otg, problem, trajectory = _ruckig()
    problem.target_position = [length]
    problem.max_velocity, problem.max_acceleration = [limits.velocity], [limits.acceleration]
    problem.max_jerk = [limits.jerk]
    if otg.calculate(problem, trajectory) != ruckig.Result.Working:
        raise ValueError(f"no motion over {length} within {limits}")
    seconds = trajectory.duration
    count = max(1, math.ceil(seconds / PERIOD))
    times = tuple(seconds * i / count for i in range(count + 1))
    ways = [trajectory.at_time(t)[0][0] for t in times]
    ways[0], ways[-1] = 0.0, length
    return times, tuple(ways)


def duration(length: float, limits: Limits) -> float:
    """Return how long `profile` takes, in closed form: speed up, cruise and slow down, each with bounded jerk."""
    v, a, j = limits.velocity, limits.acceleration, limits.jerk
    ramp = v / a + a / j if v * j >= a * a else 2 * math.sqrt(v / j)
    if length >= v * ramp:
        return length / v + ramp
    peak = a / 2 * (math.sqrt((a / j) ** 2 + 4 * length / a) - a / j)
    if peak * j >= a * a:
        return 2 * (peak / a + a / j)
    return 4 * math.cbrt(length / (2 * j))


def swing_seconds(robot: Robot, start: Joints, end: Joints, longest: float) -> float:
    """Return how long `straight` takes where the joint that goes farthest goes `longest` [rad]: joint 7 may go
    another way than from `start` to `end`, which moves no tool."""
    return duration(longest, _swing_limits(robot, start, end, longest)) if longest >= 1e-9 else 0.0


def vertical_seconds(robot: Robot, column: Column, start: float, end: float) -> float:
    """Return how long `vertical` takes [s]."""
    length = abs(end - start)
    return duration(length, _vertical_limits(robot, column, start, end)) if length >= 1e-6 else 0.0


@cache
def _ruckig() -> tuple[Any, Any, Any]:
    import ruckig

    return ruckig.Ruckig(1), ruckig.InputParameter(1), ruckig.Trajectory(1)


def _swing_limits(robot: Robot, start: Joints, end: Joints, longest: float) -> Limits:
    """What the joint that goes `longest` may do, so that the tool is not too fast either."""
    limits = joint_limits(robot)
    enough = robot.fastest * longest / limits.velocity
    way = pace(start, end, robot.gripper.tool, enough)
    return limits if way <= enough else replace(limits, velocity=robot.fastest * longest / way)


def _vertical_limits(robot: Robot, column: Column, start: float, end: float) -> Limits:
    """What the joints leave to the height [mm]: with q(z), q'' and q''' from differences over 24 steps,

    |dq/dt| <= |q'| v,  |d2q/dt2| <= |q'| a + |q''| v^2,  |d3q/dt3| <= |q'| j + 3 |q''| v a + |q'''| v^3.
    """
    first, second, third = _derivatives(column, start, end)
    joint = joint_limits(robot)
    velocity = min(joint.velocity / first, TOOL_SPEED * robot.speed, robot.fastest)
    limits = Limits(velocity, joint.acceleration / first, joint.jerk / first)
    v, a, j = limits.velocity, limits.acceleration, limits.jerk
    acceleration = first * a + second * v * v
    jerk = first * j + 3 * second * v * a + third * v**3
    return limits.scaled(
        min(1.0, math.sqrt(joint.acceleration / acceleration), math.cbrt(joint.jerk / jerk))
        if acceleration > 0
        else 1.0
    )


def _derivatives(column: Column, start: float, end: float) -> tuple[float, float, float]:
    """Greatest |q'|, |q''|, |q'''| of joints 2, 4 and 6 over the height [rad/mm, ...]."""
    steps = 24
    h = (end - start) / steps
    rows = [_at(column, start + i * h) for i in range(steps + 1)]
    greatest = []
    values = [[row[joint] for row in rows] for joint in (1, 3, 5)]
    for _ in range(3):
        values = [[(b - a) / h for a, b in pairwise(v)] for v in values]
        greatest.append(max(abs(x) for v in values for x in v))
    return greatest[0], greatest[1], greatest[2]


def _at(column: Column, z: float) -> Joints:
    joints = column.at(z)
    if joints is None:
        raise ValueError(f"the arm can't hold its tool vertical at {z:.0f} mm here")
    return joints
