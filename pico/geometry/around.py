"""The way of a load at one height past what is taller: straight, or around it. mm and deg."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from typing import TYPE_CHECKING

from pico.geometry.shape import Shape, separation

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

Point = tuple[float, float, float]
"""Where the load is: x, y, and its yaw."""

STEP = 2.0
"""How far the load goes between two looks."""
_AROUND = 8
"""Corners of a way around a thing."""
MOST_CORNERS = 80
"""Corners over which a way around is sought: a table full of tall parts has thousands."""


@dataclass(frozen=True, slots=True)
class Load:
    """What is carried, or the empty hand: its shape at a point, a radius around it, and the margin that it keeps."""

    at: Callable[[Point], Shape]
    radius: float
    margin: float


def way(
    load: Load, tall: Mapping[str, Shape], start: Point, goal: Point, size: tuple[float, float]
) -> list[Point] | str:
    """Return the corners of a way from `start` to `goal` that keeps clear of all that is too `tall` to pass over, on a
    table of `size`; the name of the first thing that is in the straight way where there is none around.

    What is nearer than the margin at either end, as it was seen to stand, only may not come nearer.
    """
    kept = {name: _kept(load, shape, start, goal) for name, shape in tall.items()}
    for corners in ([start, goal], [start, (*start[:2], goal[2]), goal], [start, (*goal[:2], start[2]), goal]):
        if not any(_met(load, tall, kept, a, b) for a, b in pairwise(corners)):
            return corners
    return _around(load, tall, kept, start, goal, size) or _met(load, tall, kept, start, goal)


def _kept(load: Load, shape: Shape, start: Point, goal: Point) -> float:
    return min(load.margin, *(separation(load.at(end), shape) - 1e-3 for end in (start, goal)))


def _met(load: Load, tall: Mapping[str, Shape], kept: Mapping[str, float], start: Point, goal: Point) -> str:
    """Return what a leg comes too near to first; empty where it is clear."""
    reach = load.radius + load.margin
    near = {n: s for n, s in tall.items() if _from_leg(s.x, s.y, start, goal) <= reach + s.radius}
    if not near:
        return ""
    long = max(math.dist(start[:2], goal[:2]), math.radians(abs(goal[2] - start[2])) * load.radius)
    count = max(1, math.ceil(long / STEP))
    for i in range(count + 1):
        x, y, yaw = (a + (b - a) * i / count for a, b in zip(start, goal, strict=True))
        shape = load.at((x, y, yaw))
        for name, other in near.items():
            if separation(shape, other) < kept[name]:
                return name
    return ""


def _from_leg(x: float, y: float, start: Sequence[float], goal: Sequence[float]) -> float:
    """Return how far a point is from a leg."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    square = dx * dx + dy * dy
    t = min(1.0, max(0.0, ((x - start[0]) * dx + (y - start[1]) * dy) / square)) if square else 0.0
    return math.hypot(x - start[0] - t * dx, y - start[1] - t * dy)


def _around(
    load: Load, tall: Mapping[str, Shape], kept: Mapping[str, float], start: Point, goal: Point,
    size: tuple[float, float],
) -> list[Point]:  # fmt: skip
    """Return the shortest way over corners around what is tall, turning at the first of them; nothing where there is
    none over those with the least detour."""
    import numpy as np

    things = np.array([(s.x, s.y, s.radius + load.radius + load.margin) for s in tall.values()])
    corners = _corners(things, start, goal, size)
    heap: list[tuple[float, int, tuple[int, ...]]] = [
        (math.dist(start[:2], c), n, (n,)) for n, c in enumerate(corners.tolist())
        if not _met(load, tall, kept, start, (*c, start[2]))
    ]  # fmt: skip
    heap.sort()
    seen: set[int] = set()
    places = corners.tolist()
    while heap:
        gone, n, trail = heappop(heap)
        if n == -1:
            first = places[trail[0]]
            return [start, (*first, start[2]), *((*places[k], goal[2]) for k in trail), goal]
        if n in seen:
            continue
        seen.add(n)
        if not _met(load, tall, kept, (*places[n], goal[2]), goal):
            heappush(heap, (gone + math.dist(places[n], goal[:2]), -1, trail))
        for k in np.flatnonzero(_clear(things, corners[n], corners)).tolist():
            if k not in seen:
                heappush(heap, (gone + math.dist(places[n], places[k]), k, (*trail, k)))
    return []


def _corners(things: Array, start: Point, goal: Point, size: tuple[float, float]) -> Array:
    """Return places (n, 2) around each thing where the load passes, above the table, or no farther out than the ends of
    the way: those with the least detour."""
    import numpy as np

    angles = 2 * math.pi * np.arange(_AROUND) / _AROUND
    far = (things[:, 2] + 1.0) / math.cos(math.pi / _AROUND)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    found = (things[:, None, :2] + far[:, None, None] * around).reshape(-1, 2)
    ends = np.array([(0.0, 0.0), size, start[:2], goal[:2]])
    found = found[((found >= ends.min(axis=0)) & (found <= ends.max(axis=0))).all(axis=1)]
    detour = sum(np.linalg.norm(found - end, axis=1) for end in ends[2:])
    found = found[np.argsort(detour, kind="stable")]
    free: list[Array] = []
    for at in range(0, len(found), MOST_CORNERS):
        some = found[at : at + MOST_CORNERS]
        gaps = np.linalg.norm(some[:, None, :] - things[None, :, :2], axis=2)
        free.append(some[(gaps > things[:, 2]).all(axis=1)])
    return np.concatenate([np.zeros((0, 2)), *free])[:MOST_CORNERS]


def _clear(things: Array, start: Array, goals: Array) -> NDArray[np.bool_]:
    """Return whether the load, however it is turned, passes everything from one corner to each of others (n, 2)."""
    import numpy as np

    way, off = goals - start, things[:, :2] - start
    square = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.clip(off @ way.T / square, 0.0, 1.0)
    gaps = np.linalg.norm(off[:, None, :] - share[:, :, None] * way, axis=2)
    clear: NDArray[np.bool_] = (gaps > things[:, 2:]).all(axis=0)
    return clear
