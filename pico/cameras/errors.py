"""What is wrong with the simulated cameras: how they differ from what the lab says of them, by seed."""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.model.record import record
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.twin.arms import direction
from pico.vision.camera import CameraModel
from pico.vision.nominal import camera_models

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@record
class CameraShift:
    """How far somebody has bumped a camera: `shift` [mm], and `turn` about itself, a rotation vector [deg], both along
    the axes of the frame that it is fixed to (the table, or the tool)."""

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def then(self, other: CameraShift) -> CameraShift:
        """Return this shift followed by `other`; turns are small, so that they add."""
        (a, b, c), (d, e, f) = self.shift, self.turn
        (u, v, w), (x, y, z) = other.shift, other.turn
        return CameraShift(shift=(a + u, b + v, c + w), turn=(d + x, e + y, f + z))


def true_cameras(
    setup: Setup, errors: SimErrors, seed: int, shifts: Mapping[str, CameraShift] | None = None
) -> dict[str, CameraModel]:
    """Return the cameras of a lab as they really are: the nominal ones, displaced, turned and with another focal
    length by what `errors` says, then bumped by `shifts`.

    Same seed, same cameras; one camera does not depend on which others there are.
    """
    nominal = camera_models(setup)
    wrong = {name: _wrong(camera, errors, seed) for name, camera in nominal.items()}
    return {name: bumped(camera, (shifts or {}).get(name, CameraShift())) for name, camera in wrong.items()}


def _wrong(camera: CameraModel, errors: SimErrors, seed: int) -> CameraModel:
    import numpy as np

    random = np.random.default_rng((seed, zlib.crc32(camera.name.encode())))
    pose, matrix = camera.pose.copy(), camera.matrix.copy()
    pose[:3, 3] += errors.camera_position * direction(random)
    pose[:3, :3] = turned(errors.camera_rotation * direction(random)) @ pose[:3, :3]
    matrix[:2, :2] *= 1 + errors.focal_length * random.choice((-1.0, 1.0))
    distortion = camera.distortion.copy()
    distortion[0] += (errors.distortion or 0.0) * random.choice((-1.0, 1.0))
    return replace(camera, pose=pose, matrix=matrix, distortion=distortion)


def bumped(camera: CameraModel, by: CameraShift) -> CameraModel:
    """Return the camera after a bump."""
    pose = camera.pose.copy()
    pose[:3, 3] += by.shift
    pose[:3, :3] = turned(by.turn) @ pose[:3, :3]
    return replace(camera, pose=pose)


def common_shifts(cameras: Mapping[str, CameraModel], drift: CameraShift) -> dict[str, CameraShift]:
    """Return the shift of each camera at the table when all of them move as one: turned about the table's origin, then
    displaced. Those on hands stay."""
    found = {}
    for name, camera in cameras.items():
        if camera.robot is None:
            way = turned(drift.turn) @ camera.pose[:3, 3] - camera.pose[:3, 3] + drift.shift
            found[name] = CameraShift(shift=(float(way[0]), float(way[1]), float(way[2])), turn=drift.turn)
    return found


def turned(vector: Any) -> Array:
    """Return the rotation (3, 3) by the rotation vector (3,) [deg] (Rodrigues)."""
    import numpy as np

    x, y, z = np.radians(np.asarray(vector, np.float64))
    angle = math.sqrt(x * x + y * y + z * z)
    cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    if angle < 1e-12:
        return np.eye(3) + cross  # type: ignore[no-any-return]
    return np.eye(3) + math.sin(angle) / angle * cross + (1 - math.cos(angle)) / angle**2 * cross @ cross  # type: ignore[no-any-return]
