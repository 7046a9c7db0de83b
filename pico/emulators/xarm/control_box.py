"""The control box itself, without any wire: registers in, answers out, at a time that is told to it.

States (support article on mode and state): 1 in motion, 2 ready, 3 paused, 4 stopped, 5 reset by a changed setting,
6 coming to rest. Modes: 0 the box plans, 1 set-points, 4 joint velocity. Assumed, since no page says: a set-point in
another mode is answered as invalid; one more than `_JUMP` from the last is fault 24.
"""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from pico.emulators.xarm.claw import Claw
from pico.emulators.xarm.inverse import Line, composed, line
from pico.emulators.xarm.kinematics import angles, rotation, tool_point, tool_pose
from pico.emulators.xarm.motions import Driven, Followed, Motion, Planned
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS

READY, MOVING, PAUSED, STOPPED, RESET, SLOWING = 2, 1, 3, 4, 5, 6
POSITION, SERVO, MANUAL, VELOCITY, ONLINE_JOINTS, ONLINE_LINE = 0, 1, 2, 4, 6, 7
_KINEMATICS = 21
SELF_COLLISION, ABNORMAL_CURRENT = 22, 31
BUTTONS = (1, 2, 3)
"""Faults of the emergency stops: they come back as long as one is pressed."""
UNPOWERED = (*BUTTONS, *range(10, 18))
"""Faults that take the power from the motors."""
_JUMP = 0.3
_ROUNDING = 1e-4


@dataclass
class Settings:
    """What is set in the box; lost when it restarts, but for what was saved."""

    offset: tuple[float, ...] = (0.0,) * 6
    world: tuple[float, ...] = (0.0,) * 6
    """Of the base in the world frame."""
    load: tuple[float, ...] = (0.0,) * 4
    sensitivity: int = 3
    teaching: int = 3
    gravity: tuple[float, ...] = (0.0, 0.0, -1.0)
    reduced: bool = False
    reduced_tool_speed: float = 1000.0
    reduced_joint_speed: float = math.pi
    joint_range: tuple[float, ...] = tuple(v for pair in LIMITS for v in pair)
    boundary: tuple[int, ...] = (9999, -9999, 9999, -9999, 9999, -9999)
    fence: bool = False
    rebound: bool = False
    self_collision: bool = False
    tool_model: int = 0
    tool_size: tuple[float, ...] = (0.0,) * 6
    jerks: dict[int, float] = field(default_factory=lambda: {31: 1000.0, 32: 50000.0, 33: 20.0, 34: 20.0})


@dataclass(frozen=True)
class Straight:
    """Where a straight way of the tool ends: a pose in the base frame."""

    pose: tuple[float, ...]


@dataclass
class ControlBox:
    """An xArm7's control box, `joints` [rad] where the arm stands.

    `moved(joints, seconds)` is told every step, and returns a fault that this meant or 0. `way(before, after)` returns
    which share of a step (0 to 1) is free, and the fault of what is in the way or 0: the arm stops where it touches. A
    collision with itself (22) is detected only where that is switched on, else it is an abnormal current (31).
    """

    joints: Joints
    serial: str = "XI130500000000"
    box_serial: str = "AC130500000000"
    firmware: str = "v2.7.1"
    axes: int = 7
    model: int = 7
    claw: Claw = field(default_factory=Claw)
    moved: Callable[[Joints, float], int] | None = None
    way: Callable[[Joints, Joints], tuple[float, int]] | None = None
    now: float = 0.0
    mode: int = POSITION
    state: int = STOPPED
    error: int = 0
    warning: int = 0
    enabled: bool = False
    pressed: int = 0
    settings: Settings = field(default_factory=Settings)
    saved: Settings = field(default_factory=Settings)
    queue: deque[tuple[Joints | Straight, float, float, int]] = field(default_factory=deque)
    motion: Motion | None = None
    finished: list[tuple[int, int]] = field(default_factory=list)
    """Transactions whose motion is over, with how it ended (0: there); told to who asked for that by register 254."""
    requested: Counter[int] = field(default_factory=Counter)
    unknown: list[int] = field(default_factory=list)
    invalid: list[int] = field(default_factory=list)
    """Registers that were answered as invalid, the unknown ones among them."""
    inputs: int = 0
    outputs: int = 0
    """Digital, a bit each."""
    analog_inputs: list[int] = field(default_factory=lambda: [0, 0])
    analog_outputs: list[int] = field(default_factory=lambda: [0, 0])
    """0 to 4095 for 0 to 10 V."""
    _doing: int = 0

    @property
    def status(self) -> int:
        """The status byte of every answer (p05)."""
        stuck = self.state in (STOPPED, RESET) or self.error or not self.enabled
        return (0x40 if self.error else 0) | (0x20 if self.warning else 0) | (0x10 if stuck else 0)

    def reset(self) -> None:
        """End all motion and wait to be started again, as after any setting that changes how the arm moves."""
        self.halt(RESET if self.state != STOPPED else STOPPED)
        self.mode = POSITION

    def halt(self, state: int) -> None:
        """End all motion where it is, with nothing left to do."""
        self.queue.clear()
        self.motion, self.state, self._doing = None, state, 0

    def fail(self, fault: int) -> None:
        """Come to a fault: stopped, and without power where it is one of the motors' or of an emergency stop."""
        self.halt(STOPPED)
        self.error = fault
        if fault in UNPOWERED:
            self.enabled = False

    def clear(self) -> None:
        """Forget a fault, unless an emergency stop is still pressed."""
        self.error = self.pressed

    def advance(self, now: float) -> None:
        """Go on to a later time [s of the emulated clock]."""
        self.now = max(now, self.now)
        self.claw.advance(self.now)
        if self.state not in (MOVING, READY) or self.error:
            return
        if self.motion is None and self.queue:
            end, speed, acceleration, self._doing = self.queue.popleft()
            if isinstance(end, Straight):
                self.motion = line(self.joints, end.pose, self.settings.offset, speed, acceleration, self.now)
                if self.motion is None:
                    self.fail(_KINEMATICS)
                    return
            else:
                self.motion = Planned(self.joints, end, speed, acceleration, self.now)
        if self.motion is None:
            self.state = READY
            return
        there = self.motion.at(self.now)
        if there != self.joints:
            self._step(there)
        if self.motion is not None:
            self._end_of(self.motion)

    def _step(self, joints: Joints) -> None:
        fault = self._forbidden(joints)
        if not fault:
            share, fault = self.way(self.joints, joints) if self.way else (1.0, 0)
            if fault:
                joints = tuple(a + share * (b - a) for a, b in zip(self.joints, joints, strict=True))
            self.joints = joints
            fault = (self.moved(joints, self.now) if self.moved else 0) or fault
        if fault == SELF_COLLISION and not self.settings.self_collision:
            fault = ABNORMAL_CURRENT
        if fault:
            self.fail(fault)
        else:
            self.state = MOVING

    def _end_of(self, motion: Motion) -> None:
        if not motion.over(self.now):
            return
        if isinstance(motion, Planned | Line):
            self.finished.append((self._doing, 0))
        self._doing = 0
        if not isinstance(motion, Followed):
            self.motion = None
        if not self.queue:
            self.state = READY

    def _forbidden(self, joints: Joints) -> int:
        """The fault that a posture is: 23 beyond a joint's range, 35 where the tool is beyond the fence."""
        ranges = self.settings.joint_range if self.settings.reduced else Settings.joint_range
        for angle, low, high in zip(joints, ranges[::2], ranges[1::2], strict=True):
            if not low - _ROUNDING <= angle <= high + _ROUNDING:
                return 23
        return 35 if self.settings.fence and self.outside(joints) else 0

    def outside(self, joints: Joints) -> bool:
        """Whether the tool, its offset included, is beyond the boundary."""
        point, limits = tool_point(joints, self.settings.offset), self.settings.boundary
        return any(not low <= v <= high for v, high, low in zip(point, limits[::2], limits[1::2], strict=True))

    def plan(self, end: Joints, speed: float, acceleration: float, transaction: int) -> None:
        """Queue a motion that the box plans; in reduced mode no faster than that allows."""
        most = self.settings.reduced_joint_speed if self.settings.reduced else math.pi
        self.queue.append((end, max(1e-4, min(speed, most)), max(0.01, min(acceleration, 20.0)), transaction))
        self.state = MOVING

    def plan_line(self, end: Straight, speed: float, acceleration: float, transaction: int) -> None:
        """Queue a straight way of the tool [mm/s, mm/s2]."""
        most = self.settings.reduced_tool_speed if self.settings.reduced else 1000.0
        self.queue.append((end, max(0.1, min(speed, most)), max(1.0, min(acceleration, 50000.0)), transaction))
        self.state = MOVING

    def replace_motion(self) -> None:
        """End what is under way for what comes now, as the online modes do."""
        self.queue.clear()
        self.motion, self._doing = None, 0

    def pose(self, joints: Joints) -> tuple[float, ...]:
        """Return the tool's pose in the world frame."""
        pose = tool_pose(joints, self.settings.offset)
        return composed(self.settings.world, pose) if any(self.settings.world) else pose

    def based(self, pose: Sequence[float]) -> tuple[float, ...]:
        """Return a pose of the world frame in the base frame."""
        if not any(self.settings.world):
            return tuple(pose)
        turn = rotation(*self.settings.world[3:]).T
        point = turn @ (np.array(pose[:3]) - np.array(self.settings.world[:3]))
        return (*point.tolist(), *angles(turn @ rotation(*pose[3:])))

    def planned_joints(self) -> Joints:
        """Return where the arm is when all joint moves before are done [rad]."""
        last = self.queue[-1][0] if self.queue else getattr(self.motion, "end", self.joints)
        return self.joints if isinstance(last, Straight) else last

    def planned_pose(self) -> tuple[float, ...]:
        """Return where the tool is in the base frame when all moves before are done."""
        last = self.queue[-1][0] if self.queue else getattr(self.motion, "end", self.joints)
        return last.pose if isinstance(last, Straight) else tool_pose(last, self.settings.offset)

    def follow(self, target: Joints) -> None:
        """Take a set-point of the servo mode."""
        motion = self.motion if isinstance(self.motion, Followed) else Followed(self.joints, self.now)
        if max(abs(a - b) for a, b in zip(motion.target, target, strict=True)) > _JUMP:
            self.fail(24)
            return
        if fault := self._forbidden(target):
            self.fail(fault)
            return
        motion.target = target
        self.motion, self.state = motion, MOVING

    def drive(self, speeds: tuple[float, ...], duration: float) -> None:
        """Take a velocity [rad/s], for so long [s]."""
        self.motion = Driven(self.joints, speeds, self.now, duration)
        self.state = MOVING if any(speeds) else READY

    def restarted(self) -> ControlBox:
        """Return the box as it is after a restart: the arm stands where it stood, what was not saved is forgotten."""
        found = ControlBox(self.joints, self.serial, self.box_serial, self.firmware, self.axes, self.model)
        found.claw, found.moved, found.now, found.pressed = self.claw, self.moved, self.now, self.pressed
        found.way = self.way
        found.settings, found.saved = self.saved, self.saved
        found.error = self.pressed
        found.requested, found.unknown, found.invalid = self.requested, self.unknown, self.invalid
        return found
