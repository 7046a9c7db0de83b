"""Datum markers, which are fixed to the table: they tell a camera that was bumped from parts that were moved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

from pico.model.lab import Datum
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.vision.calibration import Accuracy
from pico.vision.camera import CameraModel
from pico.vision.least_squares import Solution, solve
from pico.vision.markers import Marker, Markers
from pico.vision.poses import MarkerView, plane_points
from pico.vision.rigid import apart, moved, square, upright
from pico.vision.sighting import CameraMoved, Finding

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

ENOUGH = 3
"""Datums that a camera must see for its place to be told: with fewer, one that came loose looks like a bump."""
_LIMIT = 0.5  # mm on the table, beyond which a camera has moved, where the calibration is better than that
_STEPS = (1e-3,) * 3 + (1e-6,) * 3  # mm and rad, for derivatives


@dataclass(frozen=True, eq=False)
class Resection:
    """Where a camera stands as its datums tell: its pose (4, 4) [mm], and what is left of the corners [pixels]."""

    pose: Array
    residual: float


def datum_corners(datum: Datum) -> Array:
    """Return the corners (4, 3) [mm] of a datum in the table's frame, in the order of `Marker`."""
    pose = upright(Pose(datum.x, datum.y, datum.yaw), 0.0)
    corners: Array = square(datum.size) @ pose[:3, :3].T + pose[:3, 3]
    return corners


@dataclass(frozen=True, eq=False)
class SeenDatums:
    """The datums that a picture shows: their corners (n, 3) [mm] in the table's frame, where these are seen (n, 2)
    [pixels], and how well: the inverse (n / 4, 8, 8) of a root of the covariance of each marker [1/pixels], which gives
    first two numbers of its middle alone, then six of its shape."""

    corners: Array
    pixels: Array
    roots: Array

    def whitened(self, off: Array) -> Array:
        """Return by how much corners are off (2 n,), of unit variance if they are `off` (n, 2) [pixels] by noise; for
        each datum two numbers of its middle, then six of its shape."""
        import numpy as np

        white: Array = np.einsum("mij,mj->mi", self.roots, off.reshape(-1, 8)).ravel()
        return white

    def without(self, datum: int) -> SeenDatums:
        """Return all datums but one."""
        import numpy as np

        kept = np.arange(len(self.corners)) // 4 != datum
        return SeenDatums(self.corners[kept], self.pixels[kept], np.delete(self.roots, datum, axis=0))


def datums_in(setup: Setup, picture: Markers, camera: CameraModel) -> SeenDatums:
    """Return the datums that a picture by `camera` shows.

    Corners are read as if straight lines stayed straight across a marker; what the lens bends them by is put right.
    """
    import numpy as np

    by_number = {datum.marker: datum for datum in setup.lab.datums.values()}
    seen = [m for m in picture.markers if m.number in by_number and m.number not in picture.duplicates]
    corners: list[Array] = [datum_corners(by_number[m.number]) for m in seen]
    pixels: list[Array] = [m.corners - _bent(camera, at) for m, at in zip(seen, corners, strict=True)]
    apart = np.kron(np.array(((1, 1, 1, 1), (1, -1, 1, -1), (1, 1, -1, -1), (1, -1, -1, 1))) / 2, np.eye(2))
    roots: list[Array] = [np.linalg.inv(np.linalg.cholesky(apart @ m.covariance @ apart.T)) @ apart for m in seen]
    return SeenDatums(
        np.concatenate([np.zeros((0, 3)), *corners]), np.concatenate([np.zeros((0, 2)), *pixels]),
        np.array(roots).reshape(-1, 8, 8),
    )  # fmt: skip


_ACROSS = 9  # points along an edge of a marker


def _bent(camera: CameraModel, corners: Array) -> Array:
    """How far (4, 2) [pixels] the corners of the homography that fits all of a marker best are from its corners, which
    `camera` sees at `corners` (4, 3) [mm]."""
    import cv2
    import numpy as np

    along, down = (a.ravel() for a in np.meshgrid(*(np.linspace(0.0, 1.0, _ACROSS),) * 2))
    points = corners[0] + np.outer(along, corners[1] - corners[0]) + np.outer(down, corners[3] - corners[0])
    there = camera.project(np.concatenate((corners, points)))
    if not np.isfinite(there).all():
        return np.zeros((4, 2))
    straight, _ = cv2.findHomography(np.column_stack((along, down)), there[4:], 0)
    unit: Any = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))).reshape(-1, 1, 2)
    fitted: Array = cv2.perspectiveTransform(unit, straight).reshape(-1, 2) - there[:4]
    return fitted


def check(
    setup: Setup, picture: Markers, camera: CameraModel, accuracy: Accuracy
) -> tuple[CameraMoved | None, list[Finding]]:
    """Return whether a camera has moved since it was calibrated, and which datums are not where the lab says.

    A motion that all datums share is the camera's; a datum that the others don't follow came loose. Parts that were
    moved change neither.
    """
    seen = _datums_seen(setup, picture)
    if len(seen) < ENOUGH:
        return None, [_too_few(setup, camera.name, len(seen))]
    limit = max(_LIMIT, 4 * accuracy.position)
    off = {name: offset(setup.lab.datums[name], camera, marker) for name, marker in seen.items()}
    if all(distance <= limit for distance in off.values()):
        return None, []
    still = [name for name, distance in off.items() if distance <= limit / 2]
    if len(still) >= ENOUGH - 1 and len(still) == len(off) - 1:
        return None, [_loose(name, camera.name, off[name]) for name in sorted(off.keys() - still)]
    staying, found = _together(setup, seen, camera, accuracy)
    loose = [_loose(name, camera.name, off[name]) for name in sorted(seen.keys() - staying)]
    shared = max(off[name] for name in staying)
    if shared <= limit:
        return None, loose
    shift, turn = apart(camera.pose, found.pose)
    return CameraMoved(camera=camera.name, shift=shift, turn=turn, effect=shared), loose


def offset(datum: Datum, camera: CameraModel, marker: Marker) -> float:
    """Return how far from its place on the table a datum is seen [mm]."""
    import numpy as np

    there = plane_points(MarkerView(camera, marker), 0.0)
    return float(np.linalg.norm(there.mean(axis=0)[:2] - (datum.x, datum.y)))


def farthest_datum(setup: Setup, picture: Markers, camera: CameraModel) -> float:
    """Return how far from its place on the table the farthest datum is seen [mm], 0 if a camera sees none."""
    seen = _datums_seen(setup, picture)
    return max((offset(setup.lab.datums[name], camera, marker) for name, marker in seen.items()), default=0.0)


def resection(corners: Array, pixels: Array, camera: CameraModel) -> Resection:
    """Return where a camera stands that sees points (n, 3) [mm] of its parent's frame at `pixels` (n, 2)."""
    from dataclasses import replace

    import numpy as np

    def residuals(change: Array) -> Array:
        left = replace(camera, pose=moved(camera.pose, change)).project(corners) - pixels
        return np.nan_to_num(left, nan=1e4).ravel()

    solution: Solution = solve(residuals, np.zeros(6), np.array(_STEPS))
    return Resection(moved(camera.pose, solution.parameters), solution.rms * 2**0.5)


def _datums_seen(setup: Setup, picture: Markers) -> dict[str, Marker]:
    by_number = {datum.marker: name for name, datum in setup.lab.datums.items()}
    return {
        by_number[m.number]: m for m in picture.markers if m.number in by_number and m.number not in picture.duplicates
    }


def _together(
    setup: Setup, seen: Mapping[str, Marker], camera: CameraModel, accuracy: Accuracy
) -> tuple[frozenset[str], Resection]:
    """Return the most datums that one motion of the camera explains, and the motion; all where no choice explains."""
    names = sorted(seen)
    every = _resected(setup, seen, names, camera)
    for size in range(len(names), ENOUGH - 1, -1):
        tried = [(_resected(setup, seen, chosen, camera), chosen) for chosen in combinations(names, size)]
        best, chosen = min(tried, key=lambda pair: pair[0].residual)
        if best.residual <= 3 * max(accuracy.pixels, 0.1):
            return frozenset(chosen), best
    return frozenset(names), every


def _resected(setup: Setup, seen: Mapping[str, Marker], names: Sequence[str], camera: CameraModel) -> Resection:
    import numpy as np

    corners = np.concatenate([datum_corners(setup.lab.datums[name]) for name in names])
    return resection(corners, np.concatenate([seen[name].corners for name in names]), camera)


def _loose(name: str, camera: str, distance: float) -> Finding:
    text = f"datum `{name}` is seen {distance:.1f} mm from its place by `{camera}`, and the other datums are not"
    return Finding(kind="datum", text=text, component=None)


def _too_few(setup: Setup, camera: str, count: int) -> Finding:
    have = f"{count} of {len(setup.lab.datums)} datums" if setup.lab.datums else "no datums: the lab has none"
    text = f"`{camera}` sees {have}, so it can't be told whether it has moved since it was calibrated"
    return Finding(kind="datums", text=text)
