"""The arms of a lab, with the hands that hold components. mm, deg."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

from pico.model.quantities import Angle, Length, Mass
from pico.model.record import record


@record
class Fingers:
    """The gripper's fingers: thickness along the closing direction, breadth across it, how far the tips reach below
    the tool center point, how much they open beyond the part on each side [mm]."""

    thickness: Length = 14.0
    breadth: Length = 22.0
    tip: Length = 10.0
    opening: Length = 10.0


@record
class Gripper:
    """What holds a component. `fingers: none` is a vacuum gripper: it needs no room beside the part.

    `eyes`: where cameras sit beside the gripper, in the tool's frame [mm]: those of the lab that ride on the robot.
    `mass`: its own [kg]. `force`: with which the fingers close, or a vacuum gripper pulls [N]; `friction`: the
    coefficient between its pads and a part. Without them they are those of the xArm Gripper, see `XARM_GRIPPER`; of a
    vacuum gripper none is assumed.
    """

    fingers: Fingers | Literal["none"] = Fingers()
    stroke: Length = 84.0
    tool: Length = 172.0
    eyes: tuple[tuple[Length, Length, Length], ...] = ()
    mass: Mass | None = None
    force: float | None = None
    friction: float | None = None

    def __post_init__(self) -> None:
        for name in ("mass", "force", "friction"):
            if (value := getattr(self, name)) is not None and value < 0:
                raise ValueError(f"`{name}` of a gripper is {value:g}; it can't be below 0")

    @property
    def weight(self) -> float:
        """Its own mass [kg]."""
        return self.mass if self.mass is not None else XARM_GRIPPER[0] if self.fingers != "none" else 0.0

    @property
    def holds(self) -> float:
        """The greatest mass that it holds [kg]: two fingers by friction, m g = 2 mu F; a vacuum gripper, m g = F."""
        if self.fingers == "none":
            return math.inf if self.force is None else self.force / GRAVITY
        force = XARM_GRIPPER[1] if self.force is None else self.force
        friction = XARM_GRIPPER[2] if self.friction is None else self.friction
        return 2 * friction * force / GRAVITY


GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s2]."""
XARM_GRIPPER = (0.822, 30.0, 0.5)
"""Mass [kg] and closing force [N] of the xArm Gripper, of the vendor's data sheet; and the coefficient of friction that
is assumed between its rubber pads and aluminum: say `friction:` in the lab if yours is another."""
XARM7_PAYLOAD = 3.5
"""What an xArm7 carries, its hand included [kg]; the vendor's data sheet."""


@record
class Mount:
    """Where a robot's base stands: x, y on the table, z above it [mm], and where its own x axis points [deg]."""

    x: Length
    y: Length
    z: Length = 0.0
    yaw: Angle = 0.0


_ROUNDING = 1e-9
PARKED = 0.02
"""How far a joint may be from where it parks [rad]; of a gantry [m]."""
XARM7_RANGES = ((-360, 360), (-117.97, 120), (-360, 360), (-11, 225), (-360, 360), (-97, 180), (-360, 360))
"""How far the joints of an xArm7 turn, from the base outward [deg]; the vendor's published URDF."""
TOOL_SPEED = 1000.0
"""Greatest speed of the tool center point [mm/s]; the vendor's manual."""


@record
class Robot:
    """An arm. Heights are of the tool center point above the table [mm]; `speed` is a share of the joint limits, and
    the tool center point is never faster than `tool_speed` [mm/s], the vendor's limit unless less is asked for.
    `payload`: what it carries, its hand included [kg]; without, that of the model, and of a gantry no limit is known.
    """

    model: Literal["xarm7", "gantry"] = "xarm7"
    mount: Mount
    gripper: Gripper = Gripper()
    transit_height: Length = 250.0
    speed: float = 0.5
    tool_speed: float | None = None
    park: tuple[Angle, ...] = (0.0, -60.0, 0.0, 30.0, 0.0, 90.0, 0.0)
    payload: Mass | None = None

    def __post_init__(self) -> None:
        if self.payload is not None and self.payload <= 0:
            raise ValueError(f"`payload` is {self.payload:g} kg; it is above 0")
        if self.model != "xarm7":
            return
        if len(self.park) != len(XARM7_RANGES):
            raise ValueError(
                f"`park` of an xarm7 has the angles of its {len(XARM7_RANGES)} joints, not {len(self.park)}"
            )
        for number, (angle, (low, high)) in enumerate(zip(self.park, XARM7_RANGES, strict=True), 1):
            if not low <= angle <= high:
                raise ValueError(f"joint {number} of `park` is {angle:g} deg; it turns from {low:g} to {high:g} deg")

    @property
    def fastest(self) -> float:
        """The greatest speed of the tool center point [mm/s]."""
        return TOOL_SPEED if self.tool_speed is None else self.tool_speed

    @property
    def rated(self) -> float:
        """What it carries, its hand included [kg]; infinite if no limit is known."""
        if self.payload is not None:
            return self.payload
        return XARM7_PAYLOAD if self.model == "xarm7" else math.inf

    def too_heavy(self, mass: float) -> str:
        """Return why the arm can't carry a part of `mass` [kg]; empty if it can."""
        left, holds = self.rated - self.gripper.weight, self.gripper.holds
        if mass > left + _ROUNDING:
            return f"it carries {self.rated:.3g} kg with its hand of {self.gripper.weight:.2g} kg, so {left:.3g} kg"
        if mass > holds + _ROUNDING:
            return f"its gripper holds {holds:.3g} kg by friction"
        return ""

    @property
    def park_joints(self) -> tuple[float, ...]:
        """The joints where it waits [rad]; of a gantry x, y, z [m] over its mount at transit height, and yaw [rad]."""
        if self.model == "gantry":
            return (self.mount.x / 1000, self.mount.y / 1000, self.transit_height / 1000, 0.0)
        return tuple(math.radians(angle) for angle in self.park)

    def is_parked(self, joints: Sequence[float]) -> bool:
        """Return whether it stands there, within PARKED."""
        return all(abs(q - p) <= PARKED for q, p in zip(joints, self.park_joints, strict=False))
