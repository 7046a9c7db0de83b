"""The depth that a camera sees: how far along its axis the surface behind each pixel is. Millimetres."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.cameras.view import CameraView

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Gray = NDArray[np.float32]

_EVERY = 2  # pixels between rays


def measure(view: CameraView, limits: tuple[float, float]) -> Gray:
    """Return the depth (h, w) [mm] without noise, NaN outside of `limits`: a ray for each square of 2 by 2 pixels."""
    import numpy as np

    u, v, width, height = view.region
    middle = (_EVERY - 1) / 2
    across = u + middle + _EVERY * np.arange(-(-width // _EVERY))
    down = v + middle + _EVERY * np.arange(-(-height // _EVERY))
    columns, rows = np.meshgrid(across, down)
    local = view.rays(columns.reshape(-1), rows.reshape(-1))
    hits = view.hit(local)
    depth = hits.distance * 1000 / np.linalg.norm(local, axis=1)
    depth[(hits.geom < 0) | (depth < limits[0]) | (depth > limits[1])] = np.nan
    whole = np.repeat(np.repeat(depth.reshape(rows.shape), _EVERY, 0), _EVERY, 1)
    return np.ascontiguousarray(whole[:height, :width], np.float32)
