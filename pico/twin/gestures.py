"""What an arm of the twin does alone: drive along segments, come to rest, make a short gentle motion."""

from __future__ import annotations

import math
from collections.abc import Generator

from pico.motion.types import Joints, Segment, SegmentName, Stage
from pico.twin.physics import Twin

Steps = Generator[float, None, None]

CHUNK = 0.1
"""An operation in progress is resumed at least this often [s], to see whether the part is still in the hand."""
SETTLE = 0.1
"""Time between two corrections of an arm at rest [s]: two time constants of its servos."""
ROUNDS = 3
CLOSE = 5e-5
"""An arm is where it should be within this [rad]: at the tool about 0.01 mm."""
NEARLY = 3e-3
"""An arm that is this near to where it should be can look, and close its hand [rad]: at the tool about 1 mm."""
FAR = 3e-4
"""An arm that is farther than this from where it should be does not let go of a part yet [rad]."""
NUDGE_SECONDS = 0.2
"""How long a short motion takes, such as the shift of a goal."""


def walk(twin: Twin, robot: str, segments: tuple[Segment, ...]) -> Steps:
    """Drive an arm along `segments` and bring it to rest, its fingers as they are."""
    for segment in segments:
        twin.drive(robot, segment.times, segment.joints)
        yield from executing(twin, robot, segment.name, segment.moving.seconds)
    yield from steady(twin, robot, segments[-1].seconds - segments[-1].moving.seconds)


def steady(twin: Twin, robot: str, seconds: float, far: float = NEARLY) -> Steps:
    """Let an arm come to rest in a time, or as long as it takes to be within `far` of where it should be [rad]."""
    off = math.inf
    for wait in passing(seconds) if seconds > 0 else ():
        yield wait
        off = twin.trim(robot)
    if off > far:
        yield from settle(twin, robot)


def executing(twin: Twin, robot: str, segment: SegmentName, seconds: float) -> Steps:
    """Let the time of a segment pass, in chunks, and let the twin know how much of it is over."""
    gone, twin.stages[robot] = 0.0, Stage(segment)
    for wait in passing(seconds):
        yield wait
        gone += wait
        twin.stages[robot] = Stage(segment, min(1.0, gone / seconds) if seconds else 1.0)


def settle(twin: Twin, robot: str) -> Steps:
    """Wait until an arm is where it should be, correcting its set-points by what is missing."""
    for _ in range(ROUNDS):
        yield SETTLE
        if twin.trim(robot) < CLOSE:
            return
    yield SETTLE


def nudge(twin: Twin, robot: str, goal: Joints) -> Steps:
    """Bring an arm gently to `goal`, which is near."""
    count, start = 20, twin.joints(robot)
    shares = [(1 - math.cos(math.pi * i / count)) / 2 for i in range(count + 1)]
    way = tuple(tuple(a + s * (b - a) for a, b in zip(start, goal, strict=True)) for s in shares)
    twin.drive(robot, tuple(NUDGE_SECONDS * i / count for i in range(count + 1)), way)
    yield from passing(NUDGE_SECONDS)


def passing(seconds: float) -> Steps:
    """Let time pass, in chunks."""
    count = max(1, math.ceil(seconds / CHUNK - 1e-9))
    for _ in range(count):
        yield seconds / count


def backward(segment: Segment) -> Segment:
    """Return a segment walked from its end to its start."""
    times = tuple(segment.seconds - t for t in reversed(segment.times))
    return Segment(segment.name, times, segment.joints[::-1], segment.opening)
