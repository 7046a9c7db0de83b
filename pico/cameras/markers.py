"""Markers in a camera's picture: their print, drawn where it is seen, to a hundredth of a pixel.

Each pixel is the mean over a grid of points within it, whose places on the paper follow from the camera's distortion
and the plane of the paper; the print has soft edges of half a pixel.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.cameras.stickers import MODULES, QUIET, Sticker, paper
from pico.cameras.view import CameraView

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Gray = NDArray[np.float32]

_ON_PLATE = 3.0  # mm: a body never hides its own marker by less, so that paper may lie a little below its plate
_BEFORE = 0.3  # mm, from which on something is in front of the paper
_PROBES = 11  # points along an edge of the paper that are tested for what hides it
_FINE, _COARSE = 4, 3  # points along an edge of a pixel, of small and of large markers
_LARGE = 160  # pixels
_SQUARE = 8  # half pixels between points at which what hides a paper is asked for first
_EVERY = 4  # pixels between points at which the map to the paper is computed
_NEAREST = 5.0  # mm; what is nearer to the lens is not seen
_WHITE = 235.0


@dataclass(frozen=True, eq=False)
class _Paper:
    """A sticker before a camera: its pose in the camera's frame (4, 4) [mm], its body, and the box of pixels
    [left, top, right, bottom) that it lies in."""

    sticker: Sticker
    pose: Array
    body: int
    box: tuple[int, int, int, int]
    light: float


def draw_markers(view: CameraView, picture: Gray, stickers: Sequence[Sticker]) -> None:
    """Draw the stickers into `picture` (h, w), the view's region, wherever nothing hides them."""
    papers = [p for p in (_paper(view, sticker) for sticker in stickers) if p is not None]
    for one, (share, _) in zip(papers, _seen(view, papers), strict=True):
        if share > 0:
            _draw(view, picture, one, partly=share < 1)


def _paper(view: CameraView, sticker: Sticker) -> _Paper | None:
    """The sticker as the camera has it; None where it shows its back or lies outside of the picture."""
    import numpy as np

    body, pose = pose_in_table(view, sticker)
    local = np.linalg.inv(view.camera.pose) @ pose
    if local[:3, 3] @ local[:3, 2] >= 0:  # its z points away from the camera
        return None
    half = sticker.edge / 2
    rim = np.array([(x, y, 0.0) for x in (-half, 0, half) for y in (-half, 0, half)])
    points = rim @ pose[:3, :3].T + pose[:3, 3]
    if (rim @ local[2, :3] + local[2, 3]).min() < _NEAREST:
        return None
    box = _box(view, points)
    if box is None:
        return None
    light = 0.55 + 0.45 * max(0.0, float(pose[:3, 2] @ (-0.27, -0.36, 0.89)))
    return _Paper(sticker, local, body, box, light)


def pose_in_table(view: CameraView, sticker: Sticker) -> tuple[int, Array]:
    """Return the body's number (0: the table) and the pose (4, 4) of a sticker in the table's frame [mm]."""
    import numpy as np

    own = np.array(sticker.pose)
    if sticker.body is None:
        return 0, own
    body = int(view.model.body(sticker.body).id)
    pose = np.eye(4)
    pose[:3, :3] = view.data.xmat[body].reshape(3, 3)
    pose[:3, 3] = view.data.xpos[body] * 1000
    return body, pose @ own


def _box(view: CameraView, points: Array) -> tuple[int, int, int, int] | None:
    import numpy as np

    pixels = view.camera.project(points)
    u, v, width, height = view.region
    low = np.floor(pixels.min(axis=0)) - 2
    high = np.ceil(pixels.max(axis=0)) + 3
    if not np.isfinite(pixels).all():
        return None
    left, top = max(int(low[0]), u), max(int(low[1]), v)
    right, bottom = min(int(high[0]), u + width), min(int(high[1]), v + height)
    return (left, top, right, bottom) if right - left > 1 and bottom - top > 1 else None


def _seen(view: CameraView, papers: Sequence[_Paper]) -> list[tuple[float, Any]]:
    """Which share of a grid of points on each paper nothing hides, and which points (n,)."""
    import numpy as np

    if not papers:
        return []
    side = np.linspace(-0.495, 0.495, _PROBES)
    grid = np.array([(x, y, 0.0) for x in side for y in side])
    local = np.concatenate([(grid * p.sticker.edge) @ p.pose[:3, :3].T + p.pose[:3, 3] for p in papers])
    free = _unhidden(view, local, np.repeat([p.body for p in papers], len(grid)))
    return [(float(f.mean()), f) for f in free.reshape(len(papers), -1)]


def _unhidden(view: CameraView, local: Array, body: Any) -> Any:
    """Which of the points (n, 3) of the camera's frame [mm], on papers of `body` (n,), nothing hides."""
    import numpy as np

    hits = view.hit(local)
    gap = np.linalg.norm(local, axis=1) - hits.distance * 1000
    own = (hits.geom >= 0) & (view.model.geom_bodyid[hits.geom] == body)
    return gap < np.where(own, _ON_PLATE, _BEFORE)


def _draw(view: CameraView, picture: Gray, one: _Paper, *, partly: bool) -> None:
    """Draw a paper; where something hides part of it, ask for each pixel."""
    import cv2

    left, top, right, bottom = one.box
    fine = _COARSE if max(right - left, bottom - top) > _LARGE else _FINE
    where = _on_paper(view, one, fine)
    texels = _texels(view, one)
    scale = texels * MODULES / one.sticker.size
    side = (MODULES + 2 * QUIET) * texels
    middle = (side - 1) / 2 + 1
    ink: Any = paper(one.sticker.marker, texels)
    across, down = middle + where[0] * scale, middle - where[1] * scale
    mean: Any = cv2.remap(ink, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    mean = cv2.resize(mean, (right - left, bottom - top), interpolation=cv2.INTER_AREA)
    if partly:
        mean = mean * _open(view, one)[..., None]
    u, v, _, _ = view.region
    patch = picture[top - v : bottom - v, left - u : right - u]
    patch *= 1 - mean[..., 1]
    patch += _WHITE * one.light * mean[..., 0]


def _texels(view: CameraView, one: _Paper) -> int:
    """Texels a module, about two a pixel."""
    pixels = one.sticker.size / MODULES * view.camera.matrix[0, 0] / one.pose[2, 3]
    return max(2, min(48, round(float(2 * pixels))))


def _on_paper(view: CameraView, one: _Paper, fine: int) -> list[Gray]:
    """Where on the paper [mm], x and y (rows, columns), the points of the pixels of the box lie, `fine` along each
    edge."""
    import numpy as np

    left, top, right, bottom = one.box
    knots = [_knots(low, high) for low, high in ((left, right), (top, bottom))]
    columns, rows = np.meshgrid(*knots)
    rays = view.rays(columns.reshape(-1), rows.reshape(-1))
    # a ray r meets the plane of the paper at r * s; in the paper's frame that is R^T (r s - t)
    turn, at = one.pose[:3, :3], one.pose[:3, 3]
    depth = (at @ turn[:, 2]) / (rays @ turn[:, 2])
    place = ((rays * depth[:, None] - at) @ turn[:, :2]).reshape(*rows.shape, 2).astype(np.float32)
    across, down = (
        _weights(k, low, high, fine) for k, (low, high) in zip(knots, ((left, right), (top, bottom)), strict=True)
    )
    return [np.asarray(down @ place[..., i] @ across.T, np.float32) for i in (0, 1)]


def _knots(low: int, high: int) -> Array:
    import numpy as np

    count = max(2, math.ceil((high - low) / _EVERY) + 1)
    return np.linspace(low - 0.5, high - 0.5, count)


def _weights(knots: Array, low: int, high: int, fine: int) -> Gray:
    """The matrix that takes values at `knots` to the points within pixels, linear in between."""
    import numpy as np

    points = low - 0.5 + (np.arange((high - low) * fine) + 0.5) / fine
    step = knots[1] - knots[0]
    position = (points - knots[0]) / step
    first = np.clip(position.astype(int), 0, len(knots) - 2)
    weights = np.zeros((len(points), len(knots)), np.float32)
    index = np.arange(len(points))
    weights[index, first] = 1 - (position - first)
    weights[index, first + 1] = position - first
    return weights


def _open(view: CameraView, one: _Paper) -> Gray:
    """Which share (h, w) of each pixel of the box nothing hides, of four points; where all points around a square of
    some pixels are free, or none is, so are those within it."""
    import cv2
    import numpy as np

    left, top, right, bottom = one.box
    width, height = (right - left) * 2, (bottom - top) * 2

    def free(rows: Any, columns: Any) -> Any:
        rays = view.rays(left - 0.5 + (columns + 0.5) / 2, top - 0.5 + (rows + 0.5) / 2)
        turn, at = one.pose[:3, :3], one.pose[:3, 3]
        local = rays * ((at @ turn[:, 2]) / (rays @ turn[:, 2]))[:, None]
        return _unhidden(view, local, np.full(len(local), one.body))

    down, across = (np.append(np.arange(0, n - 1, _SQUARE), n - 1) for n in (height, width))
    rows, columns = np.meshgrid(down, across, indexing="ij")
    corners = free(rows.ravel(), columns.ravel()).reshape(rows.shape).astype(np.uint8)
    near = np.ones((3, 3), np.uint8)
    mixed = cv2.dilate(corners, near) != cv2.erode(corners, near)
    nearest = np.ix_((np.arange(height) + _SQUARE // 2) // _SQUARE, (np.arange(width) + _SQUARE // 2) // _SQUARE)
    found, unsure = corners[nearest].astype(np.float32), mixed[nearest].nonzero()
    found[unsure] = free(*unsure)
    share: Any = cv2.resize(found, (right - left, bottom - top), interpolation=cv2.INTER_AREA)
    return share  # type: ignore[no-any-return]
