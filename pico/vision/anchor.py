"""Cameras put right by the datum markers in their own picture. mm, deg, pixels.

A calibration ages: a mount creeps, a lens warms. What a camera that looks at the table is wrong by after it was
calibrated, a few tenths of a millimetre, hundredths of a degree and some per mille of the focal length, the datums in
the same picture tell again. Both are weighed: datums lie in one plane, and from straight above a plane can't tell a
longer lens from a lower camera; that the mount holds its height can.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from pico.model.setup import Setup
from pico.vision.camera import CameraModel
from pico.vision.datums import ENOUGH, datum_corners
from pico.vision.least_squares import solve
from pico.vision.markers import Markers
from pico.vision.rigid import moved

SHARED = 0.05
"""What pictures of 2448 x 2048 pixels leave of 6 datums when each is averaged over its corners [pixels]."""


@dataclass(frozen=True, slots=True)
class Drifting:
    """By how much a calibration may be wrong when it is used, one standard deviation each: position of a camera in
    each direction [mm], turn about each axis [deg], focal length [share]."""

    position: float = 0.2
    turn: float = 0.05
    focal_length: float = 0.005


def anchored(
    setup: Setup, camera: CameraModel, picture: Markers, drifting: Drifting = Drifting(), together: float = 0.0
) -> CameraModel:
    """Return the camera moved, turned and with the focal length that fit the datums in its picture best, as little off
    its calibration as `drifting` makes likely; as it was where it sees fewer than three.

    `together`: by how much the four corners of a marker are off in one direction, one standard deviation [pixels].
    Without it the datums are fitted most closely, which places parts best; with `SHARED` it is told best where the
    camera stands.
    """
    import numpy as np

    by_number = {datum.marker: datum for datum in setup.lab.datums.values()}
    seen = [m for m in picture.markers if m.number in by_number and m.number not in picture.duplicates]
    if len(seen) < ENOUGH:
        return camera
    corners = np.concatenate([datum_corners(by_number[marker.number]) for marker in seen])
    pixels = np.concatenate([marker.corners for marker in seen])
    noise = np.repeat([math.hypot(marker.noise, 2 * together) for marker in seen], 4)[:, None]
    sigma = np.array([drifting.position] * 3 + [math.radians(drifting.turn)] * 3 + [drifting.focal_length])

    def residuals(change):  # type: ignore[no-untyped-def]
        left = (_changed(camera, change).project(corners) - pixels) / noise
        return np.concatenate((left.ravel(), change / sigma))

    return _changed(camera, solve(residuals, np.zeros(7), sigma / 100).parameters)


def _changed(camera: CameraModel, change) -> CameraModel:  # type: ignore[no-untyped-def]
    import numpy as np

    scale = np.diag((1 + change[6], 1 + change[6], 1.0))
    return replace(camera, pose=moved(camera.pose, change[:6]), matrix=camera.matrix @ scale)
