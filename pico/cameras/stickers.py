"""Markers as printed paper on the bodies of a scene: which, where, how large. Millimetres in a body's frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from pico.model.setup import Setup
from pico.twin.surfaces import marker_image

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MODULES = 6
"""Squares along an edge of a marker, its black frame included."""
QUIET = 1
"""White squares around it."""
STRANGER_SIZE = 24.0
"""Edge length of the marker on an object that the lab does not own [mm]."""
_PAPER, _PRINT = 0.93, 0.05  # reflectance


@dataclass(frozen=True, slots=True)
class Sticker:
    """A marker on `body` (None: the table): its number, the edge length of its black square [mm], the pose (4, 4) of
    its center in the body's frame [mm], as rows: x right and y up on the print, z out of it."""

    marker: int
    size: float
    body: str | None
    pose: tuple[tuple[float, ...], ...]

    @property
    def edge(self) -> float:
        """The edge length of the paper, with the white rim [mm]."""
        return self.size * (MODULES + 2 * QUIET) / MODULES

    def raised(self, height: float) -> Sticker:
        """Return the sticker `height` [mm] farther out along its own z."""
        rows = [[*row[:3], row[3] + row[2] * height] for row in self.pose[:3]]
        return replace(self, pose=(*(tuple(row) for row in rows), self.pose[3]))


def flat(marker: int, size: float, body: str | None, at: tuple[float, float, float], yaw: float = 0.0) -> Sticker:
    """Return a sticker that lies level at `at` [mm] of a body's frame, turned by `yaw` [deg]."""
    import math

    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    x, y, z = at
    return Sticker(marker, size, body, ((c, -s, 0.0, x), (s, c, 0.0, y), (0.0, 0.0, 1.0, z), (0.0, 0.0, 0.0, 1.0)))


def stickers(
    setup: Setup, model: mujoco.MjModel, markers: Mapping[str, int | None] | None = None
) -> tuple[Sticker, ...]:
    """Return the markers of a scene: the datums of the table, those on the plates of components, those of strangers.

    `markers`: what the bodies named in it carry instead of what the inventory says; None for none. A body called
    `unknown/<number>` carries that marker on top of its first geom.
    """
    import mujoco

    names = [model.body(number).name for number in range(1, model.nbody)]
    found = [flat(d.marker, d.size, None, (d.x, d.y, 0.0), d.yaw) for _, d in sorted(setup.lab.datums.items())]
    for name in names:
        carried = (markers or {}).get(name, _inventory(setup, name))
        if carried is None:
            continue
        if name in setup.lab.inventory:
            plate = setup.type_of(name).geometry.marker
            if plate is not None:
                found.append(flat(carried, plate.size, name, plate.at))
        else:
            body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
            found.append(flat(carried, STRANGER_SIZE, name, (0.0, 0.0, _top(model, body))))
    return tuple(found)


def _inventory(setup: Setup, name: str) -> int | None:
    """The marker that a body carries as far as its name tells."""
    if name in setup.lab.inventory:
        return setup.lab.inventory[name].marker
    kind, _, number = name.partition("/")
    return int(number) if kind == "unknown" and number.isdecimal() else None


def _top(model: mujoco.MjModel, body: int) -> float:
    """How far the highest of a body's shapes reaches along the body's z [mm]."""
    first, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
    tops = [
        float(model.geom_aabb[g][2] + model.geom_aabb[g][5] + model.geom_pos[g][2]) for g in range(first, first + count)
    ]
    return max(tops, default=0.0) * 1000


@lru_cache(maxsize=512)
def paper(marker: int, texels: int) -> NDArray[np.float32]:
    """Return the print (n, n, 2) with `texels` a module: reflectance times cover, and cover (1 on the paper).

    A rim of one texel without cover runs around it, so that interpolation ends at the paper's edge.
    """
    import cv2
    import numpy as np

    modules = marker_image(marker, MODULES).astype(np.float32) / 255
    modules = np.pad(modules, QUIET, constant_values=1.0)
    side = modules.shape[0] * texels
    ink = cv2.resize(modules * (_PAPER - _PRINT) + _PRINT, (side, side), interpolation=cv2.INTER_NEAREST)
    return np.pad(np.dstack((ink, np.ones_like(ink))), ((1, 1), (1, 1), (0, 0))).astype(np.float32)
