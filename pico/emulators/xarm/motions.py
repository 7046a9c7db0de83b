"""How the emulated joints move: planned by the control box, along set-points, or at a velocity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from pico.motion.types import Joints
from pico.motion.xarm7 import JOINT_SPEED

_STILL = 1e-9


class Motion(Protocol):
    """A motion in progress."""

    def at(self, now: float) -> Joints:
        """Return where the joints are at that time [rad], which never goes back [s]."""
        ...

    def over(self, now: float) -> bool:
        """Return whether it came to its end."""
        ...


@dataclass(frozen=True, slots=True)
class Planned:
    """From one posture to another with a trapezoid of speed [rad/s, rad/s2], all joints arriving together."""

    start: Joints
    end: Joints
    speed: float
    acceleration: float
    began: float

    @property
    def _way(self) -> float:
        return max(abs(b - a) for a, b in zip(self.start, self.end, strict=True))

    @property
    def _ramp(self) -> float:
        return min(self.speed / self.acceleration, math.sqrt(self._way / self.acceleration))

    @property
    def seconds(self) -> float:
        if self._way < _STILL:
            return 0.0
        ramp = self._ramp
        return 2 * ramp + max(0.0, self._way - self.acceleration * ramp * ramp) / (self.acceleration * ramp)

    def at(self, now: float) -> Joints:
        if self.over(now):
            return self.end
        spent, ramp, top = now - self.began, self._ramp, self.acceleration * self._ramp
        left = self.seconds - spent
        gone = (
            self.acceleration * spent**2 / 2
            if spent < ramp
            else self._way - self.acceleration * left**2 / 2
            if left < ramp
            else top * (spent - ramp / 2)
        )
        share = gone / self._way
        return tuple(a + share * (b - a) for a, b in zip(self.start, self.end, strict=True))

    def over(self, now: float) -> bool:
        return now - self.began >= self.seconds


@dataclass(slots=True)
class Followed:
    """Towards the latest set-point, each joint no faster than it can; held where the set-points end."""

    joints: Joints
    time: float
    target: Joints = field(default=())

    def __post_init__(self) -> None:
        self.target = self.target or self.joints

    def at(self, now: float) -> Joints:
        most = JOINT_SPEED * max(0.0, now - self.time)
        self.joints = tuple(a + max(-most, min(most, b - a)) for a, b in zip(self.joints, self.target, strict=True))
        self.time = max(now, self.time)
        return self.joints

    def over(self, now: float) -> bool:
        return all(abs(a - b) < _STILL for a, b in zip(self.joints, self.target, strict=True))


@dataclass(frozen=True, slots=True)
class Driven:
    """At a velocity [rad/s] for so long [s]; without end where no duration was given, as the vendor's own does."""

    start: Joints
    speeds: Sequence[float]
    began: float
    duration: float = math.inf

    def at(self, now: float) -> Joints:
        spent = max(0.0, min(now - self.began, self.duration))
        return tuple(a + spent * v for a, v in zip(self.start, self.speeds, strict=True))

    def over(self, now: float) -> bool:
        return now - self.began >= self.duration or not any(self.speeds)
