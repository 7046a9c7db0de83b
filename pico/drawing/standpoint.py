"""Where to stand for a picture: in front of the table, or where fewer parts hide behind arms and one another."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import TYPE_CHECKING, Any

from pico.drawing.viewpoint import Viewpoint, framing, trimmed
from pico.twin.raycast import cast
from pico.twin.scene import OPAQUE_GROUP

if TYPE_CHECKING:
    import mujoco

_FIELD, _MARGIN = 24.0, 0.03  # deg, share of the picture
_ELEVATIONS, _AZIMUTHS = (30.0, 38.0, 48.0), (-80.0, -60.0, -100.0, -120.0)  # deg, the best first
_SEEN = 0.3
"""A part of which less than this share is seen counts as hidden."""


def standpoint(
    model: mujoco.MjModel, data: mujoco.MjData, names: Iterable[str], points: Any, width: int, height: int | None
) -> Viewpoint:
    """Return the camera that has all of `points` (n, 3) [m] in the picture and from which the fewest of the components
    `names` are hidden, of several the lowest and nearest to the front; without a `height` as high as the points are."""
    parts = sorted(names)
    views = (_framed(points, a, e, width, height) for e, a in product(_ELEVATIONS, _AZIMUTHS))
    counted: list[tuple[int, int, Viewpoint]] = []
    for view in views:
        counted.append((len(hidden(model, data, view, parts)), len(counted), view))
        if not counted[-1][0]:
            break
    return min(counted, key=lambda found: found[:2])[2]


def hidden(model: mujoco.MjModel, data: mujoco.MjData, view: Viewpoint, names: Iterable[str]) -> list[str]:
    """Return which components a camera hardly sees, for rays to them end on something else."""
    return [name for name in names if _share(model, data, view, name) < _SEEN]


def _share(model: mujoco.MjModel, data: mujoco.MjData, view: Viewpoint, name: str) -> float:
    """Which share of rays to points in a component meets it first."""
    import numpy as np

    root = model.body_rootid[model.geom_bodyid]
    mine = np.flatnonzero((root == model.body(name).id) & (model.geom_group == OPAQUE_GROUP))
    spread = np.array([(0, 0, 0), *product((-0.6, 0.6), repeat=3)], float)
    inside = model.geom_aabb[mine, None, :3] + spread * model.geom_aabb[mine, None, 3:]
    turn = data.geom_xmat[mine].reshape(-1, 3, 3)
    points = (data.geom_xpos[mine, None] + np.einsum("gij,gpj->gpi", turn, inside)).reshape(-1, 3)
    ways = points - view.eye
    hits = cast(model, data, view.eye, ways / np.linalg.norm(ways, axis=1)[:, None], (OPAQUE_GROUP, 2))
    return float(np.mean(root[hits.geom] == model.body(name).id)) if len(points) else 1.0


def _framed(points: Any, azimuth: float, elevation: float, width: int, height: int | None) -> Viewpoint:
    view = framing(points, azimuth, elevation, _FIELD, width, height or width, margin=_MARGIN)
    return view if height else trimmed(view, points, _MARGIN)
