"""Postures of an arm for a calibration: what its hand holds or its eye looks at is seen, nothing is near. mm, rad."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.built.poses import reached
from pico.motion.kinematics import columns
from pico.motion.xarm7 import LIMITS
from pico.twin.arms import TwinArm
from pico.vision.camera import CameraModel
from pico.vision.charuco import BOARD

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_LEAN = 0.35  # rad that each joint is turned away from where the tool is vertical, at most
_SPARE = 0.05  # rad that joints stay away from their limits
_INSIDE = 40.0  # pixels from a picture's edge
_STEEP = 0.5  # cosine of the angle to the board's normal under which it is still seen well
_TRIES = 4000


@dataclass(frozen=True, eq=False)
class Rests:
    """An arm at rest, several times: what its encoders read (n, 7), and where its tool truly is (n, 4, 4)."""

    read: Array
    tools: Array


def rests(arm: TwinArm, joints: Array, random: Any) -> Rests:
    """Drive an arm of which nothing is known yet through `joints` (n, 7), and let it rest at each."""

    links = arm.followed(joints, joints[0])
    return Rests(joints + arm.misread(random, len(joints)), reached(arm.robot, links, arm.built).tools)


def postures(setup: Setup, robot: str, count: int, seen: Callable[[Array], bool], random: Any) -> Array:
    """Return joints (count, 7) with the tool above all that stands on the table, where `seen` says yes of its pose (4,
    4), as the lab has the arm. Raises PicoError where there are too few."""
    import numpy as np

    arm, (width, depth) = setup.lab.robots[robot], setup.lab.table.size
    low, high = np.array(LIMITS).T
    found: list[Array] = []
    for _ in range(_TRIES):
        x, y, up, yaw = random.uniform((0, 0, 0, -180), (width, depth, 250, 180))
        joints = _near(arm, x, y, arm.transit_height + up, yaw, random)
        if joints is not None and np.all((joints > low + _SPARE) & (joints < high - _SPARE)):
            tool = reached(arm, joints[None]).tools[0]
            if tool[2, 3] > arm.transit_height and seen(tool):
                found.append(joints)
        if len(found) == count:
            return np.array(found)
    hint = "the cameras over the table must see what the arm reaches"
    text = f"{robot} finds {len(found)} postures for a calibration, not {count}"
    raise PicoError(error("calibration-board", text, hint=hint, address=robot))


def _near(arm: Robot, x: float, y: float, z: float, yaw: float, random: Any) -> Array | None:
    """Joints (7,) near which the tool is vertical at a place; None out of reach."""
    import numpy as np

    column = next(iter(columns(arm, x, y, yaw)), None)
    joints = column.at(z) if column else None
    return None if joints is None else np.array(joints) + random.uniform(-_LEAN, _LEAN, 7)


def seen_by(cameras: Sequence[CameraModel], board: Array) -> int:
    """Return how many of `cameras`, standing in the table's frame, see all of the board at a pose (4, 4), and well."""
    import numpy as np

    half = np.array(BOARD.size) / 2
    rim = np.array([(sx * half[0], sy * half[1], 0.0) for sx in (-1, 1) for sy in (-1, 1)])
    count = 0
    for camera in cameras:
        pixels = camera.project(rim @ board[:3, :3].T + board[:3, 3])
        way = camera.pose[:3, 3] - board[:3, 3]
        inside = (pixels > _INSIDE) & (pixels < np.array(camera.pixels) - _INSIDE)
        count += bool(inside.all() and way @ board[:3, 2] > _STEEP * np.linalg.norm(way))
    return count
