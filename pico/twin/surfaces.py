"""What surfaces look like: colors of components, holes and slots of the table, markers on their plates."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from pico.model.lab import Datum
from pico.model.pose import Pose
from pico.model.setup import Setup

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

STEEL = (0.700, 0.712, 0.728)
HOLE_RADIUS = 3.3
"""Of a tapped hole with its chamfer [mm]."""
_HOLE = (0.25, 0.26, 0.28)
_PLATE, _RIM = (0.600, 0.625, 0.660), (0.46, 0.49, 0.53)
_SLOT_HALF, _CORNER = 36.0, 6.0  # mm, of the plate that is drawn for a slot
_DENSITY, _LARGEST = 2.0, 3600  # pixels a mm of the painted table, and at most along an edge
_DICTIONARY = "DICT_4X4_1000"


def linear(color: Any) -> Any:
    """Return sRGB in [0, 1] as linear light (a power of 2.2)."""
    import numpy as np

    return np.asarray(color, dtype=np.float64) ** 2.2


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The paint of a scene: table picture, colors by geom, markers by body."""

    model: mujoco.MjModel
    setup: Setup
    table: NDArray[np.uint8]
    markers: dict[int, tuple[tuple[float, float, float], float, NDArray[np.uint8]]] = field(default_factory=dict)

    def albedo(self, data: mujoco.MjData, point: Array, normal: Array, geom: NDArray[np.int32], pixel: Array) -> Any:
        """Return the linear color (n, 3) of surface points [m]; `pixel` (n,): what a pixel spans there [mm]."""
        import numpy as np

        color = linear(self.model.geom_rgba[:, :3])[geom]
        top = (geom == self.model.geom("table").id) & (normal[:, 2] > 0.9)
        color[top] = self._table(point[top] * 1000, pixel[top])
        body = self.model.geom_bodyid[geom]
        for number, marker in self.markers.items():
            on = np.flatnonzero((body == number) & (geom >= 0))
            if len(on):
                self._mark(color, on, (point[on] - data.xpos[number]) @ data.xmat[number].reshape(3, 3), marker)
        return color

    def _table(self, point: Array, pixel: Array) -> Array:
        """The paint at `point` [mm], and the holes over it, faded to their mean where pixels are coarse."""
        import numpy as np

        width, depth = self.setup.lab.table.size
        height_px, width_px = self.table.shape[:2]
        u, v = point[:, 0] / width * width_px - 0.5, (1 - point[:, 1] / depth) * height_px - 0.5
        color = linear(_sample(self.table, u, v) / 255.0)
        holes = self.setup.lab.table.holes
        dx = (point[:, 0] - holes.first[0] + holes.pitch / 2) % holes.pitch - holes.pitch / 2
        dy = (point[:, 1] - holes.first[1] + holes.pitch / 2) % holes.pitch - holes.pitch / 2
        cover = np.clip((HOLE_RADIUS - np.hypot(dx, dy)) / np.maximum(pixel, 1e-3) + 0.5, 0, 1)[:, None]
        return color * (1 - 0.85 * cover) + linear(_HOLE) * 0.85 * cover  # type: ignore[no-any-return]

    def _mark(self, color: Array, on: Any, local: Array, marker: Any) -> None:
        import numpy as np

        at, size, image = marker
        x, y, z = (local * 1000 - np.array(at)).T
        inside = (np.abs(z) < 0.3) & (np.abs(x) < size / 2) & (np.abs(y) < size / 2)
        scale = image.shape[0] / size
        u, v = (x[inside] + size / 2) * scale - 0.5, (size / 2 - y[inside]) * scale - 0.5
        color[on[inside]] = linear(_sample(image, u, v) / 255.0)[:, None] * 0.9 + 0.01


def surfaces(setup: Setup, model: mujoco.MjModel, names: Any) -> Surfaces:
    """Return the paint of the scene `model` in which the components `names` stand."""
    import mujoco

    markers = {}
    for name in names:
        part = setup.lab.inventory.get(name)
        plate = setup.type_of(name).geometry.marker if part else None
        if part is None or part.marker is None or plate is None:
            continue
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        markers[body] = (plate.at, plate.size, marker_image(part.marker))
    return Surfaces(model, setup, _paint(setup), markers)


def marker_image(marker: int, pixels: int = 96) -> NDArray[np.uint8]:
    """Return the marker's square (pixels, pixels), 0 black, 255 white, as it is seen from above with y up."""
    import cv2
    import numpy as np

    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, _DICTIONARY))
    return np.asarray(cv2.aruco.generateImageMarker(dictionary, marker, pixels), np.uint8)


def _paint(setup: Setup) -> NDArray[np.uint8]:
    """What lies flat on the table: the plates of the slots and the datums, seen from above, y up (RGB)."""
    import cv2
    import numpy as np

    width, depth = setup.lab.table.size
    scale = min(_DENSITY, _LARGEST / max(width, depth))
    image = np.full((round(depth * scale), round(width * scale), 3), _bytes(STEEL), np.uint8)
    for slot in setup.lab.slots.values():
        for inset, color in ((0.0, _RIM), (1.2, _PLATE)):
            corners = _rounded(_SLOT_HALF - inset, _CORNER - inset)
            placed = np.array([slot.pose.apply(x, y) for x, y in corners])
            pixels = np.column_stack((placed[:, 0], depth - placed[:, 1])) * scale * 16 - 8
            cv2.fillConvexPoly(image, pixels.round().astype(np.int32), _bytes(color), cv2.LINE_AA, 4)
    for datum in setup.lab.datums.values():
        _lay(image, datum, depth, scale)
    return image


def _lay(image: NDArray[np.uint8], datum: Datum, depth: float, scale: float) -> None:
    """Lay a datum's marker on the table, with a white rim."""
    import cv2
    import numpy as np

    marker = np.pad(marker_image(datum.marker), 12, constant_values=255)
    side, half = marker.shape[0], datum.size / 2 * marker.shape[0] / (marker.shape[0] - 24)
    pose = Pose(datum.x, datum.y, datum.yaw)
    corners = [pose.apply(*c) for c in ((-half, half), (half, half), (half, -half), (-half, -half))]
    there = np.array([(x * scale, (depth - y) * scale) for x, y in corners], np.float32)
    here = np.array([(0, 0), (side, 0), (side, side), (0, side)], np.float32)
    turn, size = cv2.getPerspectiveTransform(here, there), (image.shape[1], image.shape[0])
    laid = cv2.warpPerspective(cv2.cvtColor(marker, cv2.COLOR_GRAY2RGB), turn, size, flags=cv2.INTER_AREA)
    covered = cv2.warpPerspective(np.full((side, side), 255, np.uint8), turn, size) > 127
    image[covered] = laid[covered]


def _rounded(half: float, radius: float) -> list[tuple[float, float]]:
    corners = ((1, 1, 0), (-1, 1, 90), (-1, -1, 180), (1, -1, 270))
    inner = half - radius
    return [
        (sx * inner + radius * math.cos(math.radians(a)), sy * inner + radius * math.sin(math.radians(a)))
        for sx, sy, start in corners
        for a in range(start, start + 91, 15)
    ]


def _sample(image: Any, u: Array, v: Array) -> Any:
    """Bilinear samples (n,) or (n, c) of an image at pixels `u`, `v`."""
    import cv2
    import numpy as np

    if not len(u):
        return np.zeros((0, *image.shape[2:]))
    side = 8192  # remap takes no image longer than 32767
    count = -(-len(u) // side) * side
    across, down = np.zeros(count, np.float32), np.zeros(count, np.float32)
    across[: len(u)], down[: len(u)] = u, v
    maps = across.reshape(-1, side), down.reshape(-1, side)
    sampled = cv2.remap(image, maps[0], maps[1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return sampled.reshape(count, *image.shape[2:])[: len(u)].astype(np.float64)


def _bytes(color: tuple[float, float, float]) -> tuple[int, int, int]:
    return (round(color[0] * 255), round(color[1] * 255), round(color[2] * 255))
