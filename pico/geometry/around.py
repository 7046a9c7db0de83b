"""The way of a load at one height past what is taller: straight, or around it. mm and deg."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise

from pico.geometry.shape import Shape, separation

Point = tuple[float, float, float]
"""Where the load is: x, y, and its yaw."""

STEP = 2.0
"""How far the load goes between two looks."""
_AROUND = 8
"""Corners of a way around a thing."""


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
    none."""
    corners = [c for c in _corners(load, tall, start, goal, size) if _clear(load, tall, c, c)]
    ends = {n for n, c in enumerate(corners) if not _met(load, tall, kept, (*c, goal[2]), goal)}
    heap: list[tuple[float, int, tuple[int, ...]]] = [
        (math.dist(start[:2], c), n, (n,)) for n, c in enumerate(corners)
        if not _met(load, tall, kept, start, (*c, start[2]))
    ]  # fmt: skip
    heap.sort()
    seen: set[int] = set()
    while heap:
        gone, n, trail = heappop(heap)
        if n == -1:
            first = corners[trail[0]]
            return [start, (*first, start[2]), *((*corners[k], goal[2]) for k in trail), goal]
        if n in seen:
            continue
        seen.add(n)
        if n in ends:
            heappush(heap, (gone + math.dist(corners[n], goal[:2]), -1, trail))
        for k, corner in enumerate(corners):
            if k not in seen and _clear(load, tall, corners[n], corner):
                heappush(heap, (gone + math.dist(corners[n], corner), k, (*trail, k)))
    return []


def _corners(
    load: Load, tall: Mapping[str, Shape], start: Point, goal: Point, size: tuple[float, float]
) -> Iterator[tuple[float, float]]:
    """Yield places around each thing, above the table, or no farther out than the ends of the way."""
    xs, ys = (0.0, size[0], start[0], goal[0]), (0.0, size[1], start[1], goal[1])
    for shape in tall.values():
        far = (shape.radius + load.radius + load.margin + 1.0) / math.cos(math.pi / _AROUND)
        for k in range(_AROUND):
            angle = 2 * math.pi * k / _AROUND
            x, y = shape.x + far * math.cos(angle), shape.y + far * math.sin(angle)
            if min(xs) <= x <= max(xs) and min(ys) <= y <= max(ys):
                yield x, y


def _clear(load: Load, tall: Mapping[str, Shape], start: Sequence[float], goal: Sequence[float]) -> bool:
    """Whether the load, however it is turned, passes everything from one corner to another."""
    return all(_from_leg(s.x, s.y, start, goal) > s.radius + load.radius + load.margin for s in tall.values())
