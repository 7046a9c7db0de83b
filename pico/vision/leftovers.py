"""What stands on the table and nobody identified: cups, tools, parts on their side or without a marker. mm, pixels.

Pictures of two cameras are laid onto the top of the table. Of the top itself they agree; whatever stands on it is
shifted from one to the other, by its height over that of the cameras. What is known to stand there, and the arms, are
left out of it, with all that they hide. Where only one camera sees the table it is compared with the gray of the table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from pico.model.setup import Setup

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.camera import CameraModel
    from pico.vision.frame import Frame

    Array = NDArray[np.float64]
    Gray = NDArray[np.float32]

_BLOCK = 16  # mm between the points of the table that are projected
_TABLE = 150.0  # gray level of the table in good light
_UNLIKE = 16.0  # gray levels in good light
_AROUND = 9.0  # mm around what is known that may belong to it
_HOLE = 7.0  # mm around the middle of a hole that is darker
_RIM = 4  # mm from the edge of the table, where the floor may be seen
_GAP = 25.0  # mm, half of what may be between pieces of one thing
_BEHIND = 45.0  # mm, the same where something hides a part of it
_HEIGHTS = (0.0, 25.0, 50.0, 75.0)  # mm, at which a thing may be wider than at its foot
_LEAST = 40.0  # mm^2 of the pictures that must differ
_MARGIN = 8.0  # mm that a thing may reach beyond where both cameras see it


@dataclass(frozen=True, slots=True)
class Leftover:
    """Something at (`x`, `y`), no part of it farther from there than `radius`."""

    x: float
    y: float
    radius: float


def leftovers(
    setup: Setup, frames: Sequence[Frame], cameras: Mapping[str, CameraModel], known: Sequence[Array]
) -> tuple[Leftover, ...]:
    """Return what `frames` of cameras over the table show on it that is none of the `known` solids: convex ones, by
    points (n, 3) of their surface. `cameras`: as the datums put them right."""
    import cv2
    import numpy as np

    laid = [_laid(setup, frame, cameras[frame.camera], known) for frame in frames if not frame.black]
    if not laid:
        return ()
    eyes = [cameras[frame.camera].pose[:3, 3] for frame in frames if not frame.black]
    plain = _plain(setup, laid[0][0].shape)
    views = [(_alike(top, free & plain), free) for top, free in laid]
    unlike = [(np.abs(top - _TABLE) > _UNLIKE) & free & plain for top, free in views]
    odd = _odd(views, unlike)
    seen = [_closed(part | (odd & free), _HOLE) for part, (_, free) in zip(unlike, views, strict=True)]
    groups, labels = cv2.connectedComponents(_closed(np.logical_or.reduce(seen), _GAP).astype(np.uint8))
    found = []
    for number in range(1, groups):
        blob = labels == number
        if (odd & blob).sum() >= _LEAST:
            parts = [part & blob for part in seen]
            whole = [not (_closed_off(part) & ~free).any() for part, (_, free) in zip(parts, views, strict=True)]
            found.append(_thing(parts, whole, eyes, setup.lab.table.size[1]))
    return tuple(sorted(found, key=lambda thing: (thing.x, thing.y)))


def _alike(top: Gray, where: Any) -> Gray:
    """A picture as bright as it is in good light, by the gray of the table itself."""
    import numpy as np

    ground = float(np.median(top[where])) if where.any() else _TABLE
    return top * np.float32(_TABLE / max(ground, 1.0))


def _odd(views: Sequence[tuple[Gray, Any]], unlike: Sequence[Any]) -> Any:
    """Where something stands for sure: two cameras do not agree, or the only one that looks there sees no table."""
    import cv2
    import numpy as np

    sees = np.sum([free for _, free in views], axis=0)
    found = np.logical_or.reduce(unlike) & (sees == 1)
    for (top, free), (other, clear) in pairwise(views):
        found |= ~(_between(top, other) & _between(other, top)) & free & clear
    found[:_RIM], found[-_RIM:], found[:, :_RIM], found[:, -_RIM:] = (False,) * 4
    opened = cv2.morphologyEx(found.astype(np.uint8), cv2.MORPH_OPEN, np.ones((2, 2), np.uint8))
    return opened > 0


def _closed_off(part: Any) -> Any:
    """A mask with what is next to it."""
    import cv2
    import numpy as np

    return cv2.dilate(part.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0


def _closed(mask: Any, gap: float) -> Any:
    import cv2
    import numpy as np

    return cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, _disc(gap)) > 0


def _laid(setup: Setup, frame: Frame, camera: CameraModel, known: Sequence[Array]) -> tuple[Gray, Any]:
    """A picture laid onto the table, a pixel a millimetre, the back of the table on top, and where it shows the table
    or something unknown on it."""
    import cv2
    import numpy as np

    width, depth = (round(v) for v in setup.lab.table.size)
    across, down = (np.arange(-_BLOCK / 2, size + 1.5 * _BLOCK, _BLOCK) for size in (width, depth))
    x, y = np.meshgrid(across, depth - down)
    pixels = camera.project(np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))).reshape(*x.shape, 2)
    pixels = np.nan_to_num(pixels, nan=-1e4) - frame.offset
    size = (x.shape[1] * _BLOCK, x.shape[0] * _BLOCK)
    maps: Any = cv2.resize(pixels.astype(np.float32), size, interpolation=cv2.INTER_LINEAR)
    maps = maps[_BLOCK : _BLOCK + depth, _BLOCK : _BLOCK + width]
    soft: Any = cv2.GaussianBlur(frame.gray, (0, 0), 1.2)
    no_map: Any = None
    top: Any = cv2.remap(soft.astype(np.float32), maps, no_map, cv2.INTER_LINEAR, borderValue=(-1.0,))
    covered = np.zeros((depth, width), np.uint8)
    for shadow in _shadows(camera, known):
        cv2.fillConvexPoly(covered, np.round((shadow * (1, -1) + (0, depth)) * 16).astype(np.int32), 1, cv2.LINE_8, 4)
    grown = cv2.dilate(covered, _disc(_AROUND))
    return top, (top >= 0) & (grown == 0) & ~_datums(setup, (depth, width))


def _shadows(camera: CameraModel, known: Sequence[Array]) -> Iterator[Array]:
    """What each solid hides of the table from a camera (n, 2) [mm]."""
    import cv2
    import numpy as np

    eye = camera.pose[:3, 3]
    for points in known:
        low = points[points[:, 2] < eye[2] - 50.0]
        if len(low):
            share = eye[2] / (eye[2] - np.maximum(low[:, 2:], 0.0))
            foot = eye[:2] + (low[:, :2] - eye[:2]) * share
            yield np.asarray(cv2.convexHull(np.clip(foot, -1e4, 1e4).astype(np.float32))[:, 0], np.float64)


def _between(top: Gray, other: Gray) -> Any:
    """Where one picture is like the other, which may lie a millimetre beside it."""
    import cv2
    import numpy as np

    near = np.ones((3, 3), np.uint8)
    return (top > cv2.erode(other, near) - _UNLIKE) & (top < cv2.dilate(other, near) + _UNLIKE)


def _plain(setup: Setup, shape: tuple[int, ...]) -> Any:
    """Where the table has no hole and does not end."""
    import cv2
    import numpy as np

    holes, (width, depth) = setup.lab.table.holes, setup.lab.table.size
    dark = np.ones(shape, np.uint8)
    dark[_RIM:-_RIM, _RIM:-_RIM] = 0
    for x in np.arange(holes.first[0], width, holes.pitch):
        for y in np.arange(holes.first[1], depth, holes.pitch):
            cv2.circle(dark, (round(x), round(depth - y)), round(_HOLE), 1, -1)
    return dark == 0


def _datums(setup: Setup, shape: tuple[int, int]) -> Any:
    import cv2
    import numpy as np

    there = np.zeros(shape, np.uint8)
    for datum in setup.lab.datums.values():
        cv2.circle(there, (round(datum.x), round(shape[0] - datum.y)), round(datum.size), 1, -1)
    return there > 0


def _disc(radius: float) -> Any:
    import cv2

    side = 2 * math.ceil(radius) + 1
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))


def _thing(parts: Sequence[Any], whole: Sequence[bool], eyes: Sequence[Array], depth: float) -> Leftover:
    """Where a thing is: what each camera sees of it is the shadow that it throws from there; what of it is higher is
    nearer to the foot of the camera than its shadow, and at each height within all shadows.

    `whole`: which cameras see all of it; where none does it may go on behind what hides it.
    """
    import cv2
    import numpy as np

    cut = not any(complete and part.sum() > 2 for part, complete in zip(parts, whole, strict=True))
    shadows = []
    for part, complete, eye in zip(parts, whole, eyes, strict=True):
        rows, columns = np.nonzero(part)
        if (complete or cut) and len(rows) > 2:
            hull = cv2.convexHull(np.column_stack((columns, rows)).astype(np.float32))[:, 0]
            shadows.append((hull, (eye[0], depth - eye[1]), eye[2]))
    where = np.zeros(parts[0].shape, bool)
    for height in _HEIGHTS:
        level = np.full(where.shape, not cut)
        for hull, foot, eye_height in shadows:
            filled = np.zeros(where.shape, np.uint8)
            moved = foot + (hull - foot) * (1 - height / eye_height)
            cv2.fillConvexPoly(filled, np.round(moved * 16).astype(np.int32), 1, cv2.LINE_8, 4)
            level = level | (filled > 0) if cut else level & (filled > 0)
        where |= level
    rows, columns = np.nonzero(where if where.any() else np.logical_or.reduce(parts))
    (x, y), radius = cv2.minEnclosingCircle(np.column_stack((columns, rows)).astype(np.float32))
    return Leftover(x=float(x), y=float(depth - y), radius=float(radius) + (_BEHIND if cut else _MARGIN))
