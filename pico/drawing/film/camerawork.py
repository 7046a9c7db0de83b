"""A scene that is photographed again and again from one place, each time only where something has moved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.drawing.lighting import KEY
from pico.drawing.perspective import FLOOR, Beam, Stage, photograph
from pico.drawing.picture import center_of, glow, model_of, pose_model, scene_extent, shadows, top_of
from pico.drawing.standpoint import standpoint
from pico.model.setup import Setup
from pico.twin.placement import Placement
from pico.twin.snapshot import Snapshot
from pico.twin.surfaces import surfaces

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.label_places import Box
    from pico.drawing.viewpoint import Viewpoint

    Array = NDArray[np.float64]

_SAMPLED = 12  # snapshots that decide what has to fit into the picture
_TILE = 4  # light is sampled in tiles of this many pixels, see `lighting`
_PENUMBRA = 0.13  # how far a shadow is blurred, as a share of the height that it falls from
_MARGIN = 3  # pixels
_AWAY = Placement((0.0, 0.0, -100.0), (1.0, 0.0, 0.0, 0.0))
"""Where a component is that isn't there."""


class Set:
    """A scene with its camera `view`."""

    def __init__(self, setup: Setup, model: mujoco.MjModel, data: mujoco.MjData, view: Viewpoint, names: Any) -> None:
        self.view = view
        self._setup, self._model, self._data = setup, model, data
        self._stage = Stage(model, data, surfaces(setup, model, names), (), center_of(setup))
        self._names: frozenset[str] = frozenset(names)
        self._picture: NDArray[np.uint8] | None = None
        self._before: tuple[Array, Array] | None = None
        self._light: object = None

    def shoot(self, now: Snapshot) -> NDArray[np.uint8]:
        """Return the picture (height, width, 3) of this moment; it is the caller's."""
        pose_model(self._setup, self._model, self._data, self._all(now), now.joints)
        lit = {name: place for name, place in now.places.items() if name not in now.dark}
        light = _lines(glow(self._setup, lit, now.places))
        if self._picture is None or light != self._light:
            self._stage = replace(self._stage, beams=glow(self._setup, lit, now.places))
            self._picture = photograph(self._stage, self.view)
        else:
            self._again(self._window())
        self._light = light
        self._before = self._data.geom_xpos.copy(), self._data.geom_xmat.copy()
        return self._picture.copy()

    def top(self, name: str, now: Snapshot) -> tuple[float, float, float]:
        """Return the point over a component where its name goes [m]."""
        place = now.places[name]
        return place.position[0], place.position[1], top_of(self._setup, name, place)

    def grip(self, name: str) -> list[tuple[str, Box]]:
        """Return the boxes [pixels] in which a component and the arms were seen in the last picture."""
        seen = shadows(self.view, self._model, self._data)
        return [(body, box) for body, box in seen if body == name or body not in self._names]

    def _all(self, now: Snapshot) -> Mapping[str, Placement]:
        return {name: now.places.get(name, _AWAY) for name in self._names}

    def _again(self, window: tuple[int, int, int, int] | None) -> None:
        if window is None or self._picture is None:
            return
        left, top, right, bottom = window
        self._picture[top:bottom, left:right] = photograph(self._stage, self.view.cut(*window))

    def _window(self) -> tuple[int, int, int, int] | None:
        """The pixels (left, top, right, bottom) in which bodies that moved, or their shadows, were or are."""
        import numpy as np

        assert self._before is not None
        xpos, xmat = self._before
        shown = (self._model.geom_group < 4) & (self._model.geom_rbound > 0)
        step = np.abs(self._data.geom_xpos - xpos).max(axis=1) + np.abs(self._data.geom_xmat - xmat).max(axis=1)
        moved = shown & (step > 1e-6)
        if not moved.any():
            return None
        radius = self._model.geom_rbound[moved]
        points = np.vstack([_reach(at[moved], radius) for at in (xpos, self._data.geom_xpos)])
        u, v, _ = self.view.project(points[points[:, 2] > -1.0]).T
        low = np.floor(np.array((u.min(), v.min())) - _MARGIN) // _TILE * _TILE
        high = np.ceil(np.array((u.max(), v.max())) + _MARGIN) // _TILE * _TILE + _TILE
        left, top = np.maximum(0, low).astype(int)
        right, bottom = np.minimum((self.view.width, self.view.height), high).astype(int)
        return (int(left), int(top), int(right), int(bottom)) if right > left and bottom > top else None


def build_set(setup: Setup, snapshots: Sequence[Snapshot], size: tuple[int, int]) -> Set:
    """Return the scene of a run, with a camera that has table and arms in the picture all the time."""
    import numpy as np

    names = {name for s in snapshots for name in s.places}
    first = {name: next(s.places[name] for s in snapshots if name in s.places) for name in names}
    model, data = model_of(setup, first)
    points = []
    for snapshot in snapshots[:: max(1, len(snapshots) // _SAMPLED)]:
        pose_model(setup, model, data, {n: snapshot.places.get(n, _AWAY) for n in names}, snapshot.joints)
        extent = scene_extent(setup, model, data)
        points.append(extent[extent[:, 2] > -1.0])
    view = standpoint(model, data, snapshot.places, np.vstack(points), *size)
    return Set(setup, model, data, view, names)


def _reach(centers: Array, radius: Array) -> Array:
    """Corners (n, 3) around balls, and around the shadows that they cast on table and floor."""
    import numpy as np

    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = (centers[:, None] + radius[:, None, None] * corners).reshape(-1, 3)
    fall = np.maximum(0.0, points[:, 2] - FLOOR)[:, None]
    shadow = points - fall * np.array(KEY) / KEY[2]
    blur = _PENUMBRA * fall * np.array([(x, y, 0) for x in (-1, 1) for y in (-1, 1)])[:, None]
    return np.vstack([points, (shadow + blur).reshape(-1, 3)])


def _lines(beams: Sequence[Beam]) -> list[list[float]]:
    return [[*beam.start.tolist(), *beam.end.tolist()] for beam in beams]
