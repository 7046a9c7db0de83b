"""Light that falls on what a camera sees: a soft key light and a bright sky, each with its shadows.

A surface point sees many points of the key light and of the sky. Testing all of them at each pixel would be slow, so
each pixel of a 4 x 4 tile tests its own few, and a filter that stops at edges averages over the tile (interleaved
sampling; Keller and Heidrich, 2001).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Sees = Callable[[Array, Array], NDArray[np.bool_]]

KEY = (-0.45, -0.55, 1.25)
"""Direction towards the key light."""
_DISTANCE = 4.0  # m, of all lights from the middle of the scene
_KEY_RADIUS = 0.45  # m
_TILE = 4
_PER_PIXEL = 2
_COUNT = _TILE * _TILE * _PER_PIXEL
_GOLDEN = math.pi * (3 - math.sqrt(5))


def key_points(middle: Array) -> Array:
    """Return points (n, 3) of the key light, a disc that faces `middle`."""
    import numpy as np

    towards = np.array(KEY) / np.linalg.norm(KEY)
    side = np.cross(towards, (0.0, 0.0, 1.0))
    side /= np.linalg.norm(side)
    up = np.cross(side, towards)
    i = np.arange(_COUNT)
    radius, angle = _KEY_RADIUS * np.sqrt((i + 0.5) / _COUNT), i * _GOLDEN
    disc: Array = (radius * np.cos(angle))[:, None] * side + (radius * np.sin(angle))[:, None] * up
    points: Array = middle + _DISTANCE * towards + disc
    return points


def sky_points(middle: Array) -> Array:
    """Return points (n, 3) of the sky around `middle`, denser towards the zenith as a level surface weighs them."""
    import numpy as np

    i = np.arange(_COUNT)
    sine, angle = np.sqrt((i + 0.5) / _COUNT) * 0.97, i * _GOLDEN
    directions = np.column_stack((sine * np.cos(angle), sine * np.sin(angle), np.sqrt(1 - sine**2)))
    return middle + _DISTANCE * directions


def share_seen(lights: Array, points: Array, normals: Array, mask: Any, sees: Sees) -> Array:
    """Return (h, w) which share of `lights` reaches the surface seen by each pixel, filtered; 1 outside `mask`.

    `points`, `normals`: (h, w, 3); `mask`: (h, w), where there is a surface.
    """
    import numpy as np

    raw = np.ones(mask.shape)
    raw[mask] = 0.0
    # pixel (y, x) of a tile takes every 16th light, in an order in which neighbors are far apart
    order = np.random.default_rng(7).permutation(_COUNT)
    for number, light in enumerate(lights[order]):
        y, x = divmod(number % (_TILE * _TILE), _TILE)
        tile = (slice(y, None, _TILE), slice(x, None, _TILE))
        there = mask[tile]
        reached = sees(light, points[tile][there])
        raw[tile][there] += reached / _PER_PIXEL
    return _filtered(raw, points, normals, mask)


def _filtered(raw: Array, points: Array, normals: Array, mask: Any) -> Array:
    """Average over a tile around each pixel, over what lies in the same plane and faces the same way."""
    import numpy as np

    value, point, normal = raw.astype(np.float32), points.astype(np.float32), normals.astype(np.float32)
    total, weight = np.zeros_like(value), np.zeros_like(value)
    height, width = value.shape
    for dy in range(-2, _TILE - 2):
        for dx in range(-2, _TILE - 2):
            here = (slice(max(0, -dy), height - max(0, dy)), slice(max(0, -dx), width - max(0, dx)))
            there = (slice(max(0, dy), height - max(0, -dy)), slice(max(0, dx), width - max(0, -dx)))
            alike = np.einsum("ijk,ijk->ij", normal[here], normal[there]) > 0.85
            apart = np.einsum("ijk,ijk->ij", normal[here], point[there] - point[here])
            fits = (alike & (np.abs(apart) < 0.004) & mask[there]).astype(np.float32)
            total[here] += fits * value[there]
            weight[here] += fits
    return np.where(mask, total / np.maximum(weight, 1e-6), 1.0)
