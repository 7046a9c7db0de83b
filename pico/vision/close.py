"""Where in a camera's picture a plate is to be looked for: a region, instead of the whole sensor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.model.catalog import MarkerPlate
from pico.vision.camera import CameraModel
from pico.vision.frame import Region
from pico.vision.rigid import motion, square

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

ROOM = 1.5
"""The region in which a plate is looked for is as large as the plate and so many halves of it to every side."""
_SEEN = 8
"""Pixels of a region that must be on the sensor, at least."""


def plate_pose(plate: MarkerPlate) -> Array:
    """Return the pose (4, 4) of a plate in the frame of its part [mm]."""
    import numpy as np

    return motion(np.eye(3), np.array(plate.at))


def region_about(camera: CameraModel, plate: Array, size: float) -> Region | None:
    """Return where a camera should see a plate of `size` [mm] whose pose in the camera's parent is about `plate`
    (4, 4), with room around it; None where that is off its sensor."""
    import numpy as np

    corners = camera.project(square(size) @ plate[:3, :3].T + plate[:3, 3])
    if not np.isfinite(corners).all():
        return None
    low, high = corners.min(axis=0), corners.max(axis=0)
    room = ROOM * (high - low).max() / 2
    first, last = np.floor(low - room).astype(int), np.ceil(high + room).astype(int)
    width, height = camera.pixels
    if last.min() < _SEEN or first[0] > width - _SEEN or first[1] > height - _SEEN:
        return None
    return int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1])
