"""What is wrong with the simulated cameras: how they differ from what the lab says of them, by seed."""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.model.lab import Setup, SimErrors
from pico.vision.camera import CameraModel
from pico.vision.nominal import camera_models

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def true_cameras(setup: Setup, errors: SimErrors, seed: int) -> dict[str, CameraModel]:
    """Return the cameras of a lab as they really are: the nominal ones, displaced, turned and with another focal
    length by what `errors` says. Same seed, same cameras; one camera does not depend on which others there are."""
    return {name: _wrong(camera, errors, seed) for name, camera in camera_models(setup).items()}


def _wrong(camera: CameraModel, errors: SimErrors, seed: int) -> CameraModel:
    import numpy as np

    random = np.random.default_rng((seed, zlib.crc32(camera.name.encode())))
    pose, matrix = camera.pose.copy(), camera.matrix.copy()
    pose[:3, 3] += errors.camera_position * _direction(random)
    pose[:3, :3] = turned(errors.camera_rotation * _direction(random)) @ pose[:3, :3]
    matrix[:2, :2] *= 1 + errors.focal_length * random.choice((-1.0, 1.0))
    return replace(camera, pose=pose, matrix=matrix)


def bumped(camera: CameraModel, shift: Array, turn: Array) -> CameraModel:
    """Return the camera displaced by `shift` (3,) [mm] and turned about itself by `turn` (3,) [deg], a rotation vector,
    both along the axes of its parent's frame."""
    pose = camera.pose.copy()
    pose[:3, 3] += shift
    pose[:3, :3] = turned(turn) @ pose[:3, :3]
    return replace(camera, pose=pose)


def drifted(cameras: Mapping[str, CameraModel], shift: Array, turn: Array) -> dict[str, CameraModel]:
    """Return the cameras with all that stand at the table moved as one: turned about the table's origin by `turn` (3,)
    [deg], then displaced by `shift` (3,) [mm]. Those on hands stay."""
    import numpy as np

    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = turned(turn), shift
    return {n: c if c.robot else replace(c, pose=motion @ c.pose) for n, c in cameras.items()}


def turned(vector: Any) -> Array:
    """Return the rotation (3, 3) by the rotation vector (3,) [deg] (Rodrigues)."""
    import numpy as np

    x, y, z = np.radians(np.asarray(vector, np.float64))
    angle = math.sqrt(x * x + y * y + z * z)
    cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    if angle < 1e-12:
        return np.eye(3) + cross  # type: ignore[no-any-return]
    return np.eye(3) + math.sin(angle) / angle * cross + (1 - math.cos(angle)) / angle**2 * cross @ cross  # type: ignore[no-any-return]


def _direction(random: Any) -> Array:
    import numpy as np

    way = random.normal(size=3)
    return way / np.linalg.norm(way)  # type: ignore[no-any-return]
