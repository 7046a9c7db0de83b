"""What a camera sees of a scene at an instant: bodies, arms, the top of the table, without OpenGL. Millimetres, pixels.

Rays run on a grid that is refined where neighbors hit different things, down to every second pixel; between them the
picture is interpolated. Gray levels are floats of 0 to 255.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from pico.model.setup import Setup
from pico.twin.raycast import FAR, Hits, cast
from pico.twin.scene import OPAQUE_GROUP
from pico.vision.camera import CameraModel
from pico.vision.frame import Region

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Gray = NDArray[np.float32]

_SOLID = (OPAQUE_GROUP, 2)  # bodies and arms; what is clear hides nothing
_STRIDES = (8, 4, 2)  # pixels between rays
_STEP = 10.0  # gray levels between neighbors from which it is worth to look closer
_LIGHT = (-0.27, -0.36, 0.89)
_AMBIENT = 0.55
_FLOOR = 38.0
_EXACT = (3, 60, 1e-12)  # undistort up to 60 times, or until nothing changes
_PAINT = 1.0  # pixels a mm of the painted table


@dataclass(frozen=True, eq=False)
class CameraView:
    """A camera in the table's frame and the part of its sensor that is read."""

    model: mujoco.MjModel
    data: mujoco.MjData
    camera: CameraModel
    region: Region

    @property
    def eye(self) -> Array:
        """Where the camera is [mm]."""
        return self.camera.pose[:3, 3]

    def rays(self, u: Array, v: Array) -> Array:
        """Return the directions (n, 3) of unit depth, in the camera's frame, of the pixels `u`, `v` (n,) of the
        sensor."""
        import cv2
        import numpy as np

        camera = self.camera
        if not camera.distortion.any() or not len(u):
            x, y = (u - camera.matrix[0, 2]) / camera.matrix[0, 0], (v - camera.matrix[1, 2]) / camera.matrix[1, 1]
            return np.column_stack((x, y, np.ones(len(u))))
        pixels = np.column_stack((u, v)).reshape(-1, 1, 2)
        flat = cv2.undistortPoints(pixels, camera.matrix, camera.distortion, None, None, None, _EXACT)
        return np.column_stack((np.asarray(flat).reshape(-1, 2), np.ones(len(u))))

    def hit(self, local: Array) -> Hits:
        """Return what rays along `local` (n, 3) of the camera's frame hit; in metres of the table's frame."""
        import numpy as np

        ways = local @ self.camera.pose[:3, :3].T
        ways /= np.sqrt(np.einsum("ij,ij->i", ways, ways))[:, None]
        return cast(self.model, self.data, self.eye / 1000, ways, _SOLID)

    def lattice(self, stride: int) -> tuple[Array, Array]:
        """Return the columns and rows of the sensor at which rays run: the middles of squares of `stride` pixels, a
        multiple of the coarsest stride beyond the region."""
        import numpy as np

        u, v, width, height = self.region
        coarse = _STRIDES[0]
        across, down = (np.arange(-(-n // coarse) * coarse // stride + 1.0) for n in (width, height))
        return u + 0.5 + stride * across, v + 0.5 + stride * down


def photograph(view: CameraView, table: Gray) -> Gray:
    """Return the gray levels (h, w) of everything but the markers; `table`: see `table_paint`."""
    import cv2

    _, _, width, height = view.region
    solid = _refined(view)
    size = (solid.shape[1] * 2, solid.shape[0] * 2)
    level, cover = (cv2.resize(one, size, interpolation=cv2.INTER_LINEAR)[:height, :width] for one in cv2.split(solid))
    picture = _table(view, table)
    picture *= 1 - cover
    picture += level
    return picture


def _refined(view: CameraView) -> Gray:
    """What stands in front of the table (rows, columns, 2) at every second pixel: gray level times cover, and cover."""
    import numpy as np

    solid, geom = _look(view, *(a.reshape(-1) for a in np.meshgrid(*view.lattice(_STRIDES[0]))))
    shape = tuple(len(a) for a in reversed(view.lattice(_STRIDES[0])))
    solid, geom = solid.reshape(*shape, 2), geom.reshape(shape)
    for stride in _STRIDES[1:]:
        rough = _rough(solid, geom)
        solid, geom = _between(solid), np.repeat(np.repeat(geom, 2, 0), 2, 1)[:-1, :-1]
        rows, columns = np.nonzero(rough)
        across, down = view.lattice(stride)
        solid[rows, columns], geom[rows, columns] = _look(view, across[columns], down[rows])
    return solid


def _look(view: CameraView, u: Array, v: Array) -> tuple[Gray, Any]:
    """Gray level and cover (n, 2) of what stands at pixels, and the geoms (n,): -1 for table and floor."""
    import numpy as np

    hits = view.hit(view.rays(u, v))
    geom = np.where(hits.geom == view.model.geom("table").id, -1, hits.geom)
    there = geom >= 0
    light = _AMBIENT + (1 - _AMBIENT) * np.maximum(0.0, hits.normal[there] @ _LIGHT)
    solid = np.zeros((len(u), 2), np.float32)
    solid[there, 0] = 240.0 * light * (view.model.geom_rgba[geom[there], :3] @ (0.299, 0.587, 0.114))
    solid[there, 1] = 1.0
    return solid, geom


def _rough(solid: Gray, geom: Any) -> Any:
    """Which points of the grid of half the stride lie in or around squares whose corners differ."""
    import numpy as np

    corners = [(slice(a, a + geom.shape[0] - 1), slice(b, b + geom.shape[1] - 1)) for a in (0, 1) for b in (0, 1)]
    first = geom[corners[0]]
    other = np.zeros(first.shape, bool)
    for corner in corners[1:]:
        other |= geom[corner] != first
    levels = np.stack([solid[corner][..., 0] for corner in corners])
    other |= np.ptp(levels, axis=0) > _STEP
    rough = np.zeros((2 * geom.shape[0] - 1, 2 * geom.shape[1] - 1), bool)
    rough[1::2, 1::2] = other
    rough[0:-1:2, 1::2] |= other
    rough[2::2, 1::2] |= other
    rough[1::2, 0:-1:2] |= other
    rough[1::2, 2::2] |= other
    return rough


def _between(grid: Gray) -> Gray:
    """The grid with a point between each two neighbors, their mean."""
    import numpy as np

    fine = np.empty((2 * grid.shape[0] - 1, 2 * grid.shape[1] - 1, grid.shape[2]), np.float32)
    fine[::2, ::2] = grid
    fine[1::2, ::2] = (grid[:-1] + grid[1:]) / 2
    fine[:, 1::2] = (fine[:, :-2:2] + fine[:, 2::2]) / 2
    return fine


def _table(view: CameraView, table: Gray) -> Gray:
    """The painted table (h, w), and the floor around it."""
    import cv2
    import numpy as np

    _, _, width, height = view.region
    coarse = _STRIDES[0] * 2
    u = view.region[0] + (coarse - 1) / 2 + coarse * np.arange(-(-width // coarse))
    v = view.region[1] + (coarse - 1) / 2 + coarse * np.arange(-(-height // coarse))
    columns, rows = np.meshgrid(u, v)
    ways = view.rays(columns.reshape(-1), rows.reshape(-1)) @ view.camera.pose[:3, :3].T
    fall = np.minimum(ways[:, 2], -1e-3)  # what looks up sees the floor far away
    foot = view.eye[:2] - ways[:, :2] * (view.eye[2] / fall)[:, None]
    foot = np.clip(foot, -FAR * 1000, FAR * 1000)
    pixel = np.column_stack((foot[:, 0], table.shape[0] / _PAINT - foot[:, 1])) * _PAINT - 0.5
    maps = pixel.reshape(len(v), len(u), 2).astype(np.float32)
    whole: Any = _stretched(maps, coarse)[:height, :width]
    floor = (_FLOOR,)
    no_map: Any = None
    seen: Any = cv2.remap(table, whole, no_map, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=floor)
    return seen  # type: ignore[no-any-return]


def _stretched(maps: Gray, factor: int) -> Gray:
    """A map (rows, columns, 2) at the middles of squares of `factor` pixels, at every pixel; linear beyond its edge."""
    import cv2
    import numpy as np

    padded = (
        np.pad(maps, ((1, 1), (1, 1), (0, 0)), mode="reflect", reflect_type="odd") if min(maps.shape[:2]) > 1 else maps
    )
    size = (padded.shape[1] * factor, padded.shape[0] * factor)
    whole: Any = cv2.resize(padded, size, interpolation=cv2.INTER_LINEAR)
    inset = factor if min(maps.shape[:2]) > 1 else 0
    laid: Gray = whole[inset:, inset:]
    return laid


@lru_cache(maxsize=4)
def _painted(size: tuple[float, float], pitch: float, first: tuple[float, float]) -> Gray:
    import cv2
    import numpy as np

    width, depth = size
    paint = np.full((round(depth * _PAINT), round(width * _PAINT)), 150, np.uint8)
    for x in np.arange(first[0], width, pitch):
        for y in np.arange(first[1], depth, pitch):
            at = (round((x * _PAINT - 0.5) * 16), round(((depth - y) * _PAINT - 0.5) * 16))
            cv2.circle(paint, at, round(3.3 * 16 * _PAINT), (70,), -1, cv2.LINE_AA, 4)
    return paint.astype(np.float32)


def table_paint(setup: Setup) -> Gray:
    """Return the gray levels of the table's top with its holes, seen from above with y up, a pixel a millimetre."""
    holes = setup.lab.table.holes
    return _painted(setup.lab.table.size, holes.pitch, holes.first)
