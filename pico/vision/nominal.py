"""The cameras as the lab describes them: what holds until they are calibrated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pico.model.lab import Camera
from pico.model.setup import Setup
from pico.vision.camera import CameraModel

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def camera_models(setup: Setup) -> dict[str, CameraModel]:
    """Return the cameras of a lab by name; the pose of one on a robot's hand is in the tool's frame."""
    return {name: nominal(name, camera) for name, camera in sorted(setup.lab.cameras.items())}


def nominal(name: str, camera: Camera) -> CameraModel:
    """Return the camera with square pixels and its principal point at the middle of the sensor."""
    import numpy as np

    width, height = camera.pixels
    focal = height / 2 / math.tan(math.radians(camera.field_of_view) / 2)
    matrix = np.array(((focal, 0, (width - 1) / 2), (0, focal, (height - 1) / 2), (0, 0, 1)))
    pose = looking(camera.position, camera.look_at, camera.roll)
    distortion = np.array(camera.distortion)
    return CameraModel(name, camera.pixels, matrix, distortion, pose, camera.robot, camera.depth is not None)


def looking(position: Sequence[float], target: Sequence[float], roll: float = 0.0) -> Array:
    """Return the pose (4, 4) of a camera at `position` that looks at `target` [mm].

    Up in the picture is +y where it looks steeper than 45 deg along z, else +z; `roll` [deg] turns the camera about its
    axis, clockwise as it sees.
    """
    import numpy as np

    eye = np.asarray(position, np.float64)
    forward = np.asarray(target, np.float64) - eye
    forward /= np.linalg.norm(forward)
    up = np.array((0.0, 1.0, 0.0) if abs(forward[2]) > math.sqrt(0.5) else (0.0, 0.0, 1.0))
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    c, s = math.cos(math.radians(roll)), math.sin(math.radians(roll))
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((right, np.cross(forward, right), forward)) @ ((c, -s, 0), (s, c, 0), (0, 0, 1))
    pose[:3, 3] = eye
    return pose
