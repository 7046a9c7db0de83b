"""What the cameras over a bench hang above, in perspective: a ring on the table, and a tick to where they look."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pico.drawing.outlines import circle
from pico.model.setup import Setup
from pico.twin.raycast import visible
from pico.twin.scene import OPAQUE_GROUP

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.viewpoint import Viewpoint

_EYE = (96, 76, 140)
_RADIUS, _TICK = 16.0, 45.0  # mm


def mark_cameras(
    image: NDArray[np.uint8], view: Viewpoint, setup: Setup, model: mujoco.MjModel, data: mujoco.MjData
) -> None:
    """Draw into `image` (h, w, 3) where each camera that no arm carries hangs, as far as nothing stands in front."""
    import cv2
    import numpy as np

    for camera in setup.lab.cameras.values():
        if camera.robot is not None:
            continue
        (x, y, _), (to_x, to_y, _) = camera.position, camera.look_at
        ring = circle((x, y), _RADIUS, 48)
        away = math.hypot(to_x - x, to_y - y)
        reach = [_RADIUS + (_TICK - _RADIUS) * n / 8 for n in range(9)] if away > 1.0 else []
        tick = [(x + r * (to_x - x) / away, y + r * (to_y - y) / away) for r in reach]
        for line in ([*ring, ring[0]], tick):
            points = np.array([(px / 1000, py / 1000, 1e-4) for px, py in line]).reshape(-1, 3)
            shown = visible(model, data, view.eye, points, (OPAQUE_GROUP, 2))
            pixels = np.round(view.project(points)[:, :2] * 16).astype(int)
            for n in np.flatnonzero(shown[:-1] & shown[1:]):
                cv2.line(image, tuple(pixels[n]), tuple(pixels[n + 1]), _EYE, 2, cv2.LINE_AA, 4)
