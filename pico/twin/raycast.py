"""What rays hit in a MuJoCo scene: pictures without OpenGL. Metres, table frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FAR = 50.0
"""Nothing is farther away [m]."""


@dataclass(frozen=True, eq=False)
class Hits:
    """Where rays ended: distance (n,), FAR for none; point and outward normal (n, 3); geom's id (n,), -1 for none."""

    distance: Array
    point: Array
    normal: Array
    geom: NDArray[np.int32]


def cast(model: mujoco.MjModel, data: mujoco.MjData, origin: Array, directions: Array, groups: tuple[int, ...]) -> Hits:
    """Return what rays from `origin` (3,) along unit `directions` (n, 3) hit first among the geoms in `groups`."""
    import mujoco
    import numpy as np

    count = len(directions)
    geom, distance = np.full(count, -1, np.int32), np.full(count, -1.0)
    normal = np.zeros(3 * count)
    flat = np.ascontiguousarray(directions, dtype=np.float64).reshape(-1)
    if count:
        mujoco.mj_multiRay(model, data, origin, flat, _mask(groups), True, -1, geom, distance, normal, count, FAR)
    distance[geom < 0] = FAR
    return Hits(distance, origin + distance[:, None] * directions, normal.reshape(-1, 3), geom)


def visible(
    model: mujoco.MjModel, data: mujoco.MjData, light: Array, points: Array, groups: tuple[int, ...]
) -> NDArray[np.bool_]:
    """Return (n,) whether `light` (3,) reaches each of `points` (n, 3), which lie on surfaces of the scene.

    Rays run from the light, which is the one origin that all of them share.
    """
    import mujoco
    import numpy as np

    count = len(points)
    if not count:
        return np.zeros(0, bool)
    geom, distance = np.full(count, -1, np.int32), np.full(count, -1.0)
    ways = points - light
    flat = np.ascontiguousarray(ways).reshape(-1)
    mujoco.mj_multiRay(model, data, light, flat, _mask(groups), True, -1, geom, distance, None, count, FAR)
    reached: Any = (geom < 0) | (distance >= 1.0 - 1e-3 / np.linalg.norm(ways, axis=1))
    return reached  # type: ignore[no-any-return]


def _mask(groups: tuple[int, ...]) -> NDArray[np.uint8]:
    import numpy as np

    return np.array([group in groups for group in range(6)], np.uint8)
