"""The ways of arms on a bench as it is now, found anew whatever a plan reckoned with. For every backend."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from pico.backends import checks
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.types import Blocked, Joints, Motion, MovePath
from pico.motion.zones import enters, shared_zones
from pico.planning.routines import Routine, carried, ways_of


def elsewhere(seen: Observation, robot: str) -> dict[str, Joints]:
    """Return the joints of the other arms as they are now."""
    return {name: other.joints for name, other in seen.robots.items() if name != robot}


def carrying(
    setup: Setup, motion: Motion, seen: Observation, operation: Operation, planned: Pose, goal: Pose
) -> tuple[Pose, MovePath | Blocked]:
    """Return where a part stands, or is in the hand, and the path that takes it from there to its goal; raises Failed
    where it is not where it was `planned` to be picked, or the hand is not free."""
    name, robot = operation.component, operation.robot or ""
    standing, others = checks.standing(setup, seen), elsewhere(seen, robot)
    if checks.in_hand(operation):
        held = checks.require_held(setup, seen, operation)
        return held, motion.set_down(robot, name, held, goal, standing, seen.robots[robot].joints, others)
    start, yaw = checks.require_ready(setup, seen, operation, planned), operation.arguments.get("grasp_yaw", 0.0)
    now = seen.robots[robot].joints
    return start, motion.move(robot, name, start, goal, float(yaw), standing, now, others)


def back(setup: Setup, motion: Motion, seen: Observation, operation: Operation, start: Pose) -> MovePath | None:
    """Return the way back to where a part was picked; None where there is none, or the hand holds nothing."""
    name, robot = operation.component, operation.robot or ""
    part = seen.components[name]
    if part.presence != "held" or part.pose is None:
        return None
    standing, joints = checks.standing(setup, seen), seen.robots[robot].joints
    found = motion.set_down(robot, name, part.pose, start, standing, joints, elsewhere(seen, robot))
    return None if isinstance(found, Blocked) else found


def parking(setup: Setup, motion: Motion, seen: Observation, robot: str) -> MovePath | Blocked:
    """Return the way of an arm to its park pose."""
    joints = seen.robots[robot].joints
    return motion.park(robot, joints, checks.standing(setup, seen), elsewhere(seen, robot))


def backwards(path: MovePath, start: Joints) -> MovePath:
    """Return a path the other way round, from `start`, which is where it ends but for a hair."""
    segments = [
        replace(one, times=tuple(one.seconds - t for t in reversed(one.times)), joints=tuple(reversed(one.joints)))
        for one in reversed(path.segments)
    ]
    segments[0] = replace(segments[0], joints=(start, *segments[0].joints[1:]))
    return replace(path, segments=tuple(segments))


def using(
    setup: Setup, motion: Motion, seen: Observation, operation: Operation, routine: Routine
) -> tuple[Pose, tuple[MovePath, ...]]:
    """Return where the tool of a routine stands, and the ways of the arm of its operation; raises Failed where the hand
    is not free, and for what is in the way."""
    robot, tool = operation.robot or "", routine.tool
    start = checks.require_ready(setup, seen, carried(operation, tool, Pose(0, 0)), checks.standing_pose(seen, tool))
    found = ways_of(setup, motion, seen, robot, routine, checks.standing(setup, seen))
    if isinstance(found, Blocked):
        raise checks.blocked(operation.component, found)
    return start, found


class Zones:
    """Which zones that arms share are taken, by the arm that may be there now."""

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        self._taken: dict[str, set[str]] = {}

    @contextmanager
    def held(self, operation: Operation, path: MovePath) -> Iterator[None]:
        """Keep others out of the zones that an operation holds, or comes into on the way found anew, while it runs.

        Raises Failed where that way comes into a zone of another arm at work: the plan let both run at once.
        """
        shared = [z for z in shared_zones(self._setup) if path.robot in z.robots]
        inside = {z.name for z in shared if enters(self._setup, z, path)}
        for robot, zones in self._taken.items():
            if inside & zones:
                raise checks.meets(operation.component, robot, min(inside & zones))
        self._taken[path.robot] = inside | {z.name for z in shared if z.name in operation.resources}
        try:
            yield
        finally:
            del self._taken[path.robot]
