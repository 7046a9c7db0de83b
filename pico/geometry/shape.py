"""Shapes on the table: discs and convex polygons, placed; the signed distance between two of them. All in mm."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from pico.model.catalog import Footprint
from pico.model.pose import Pose

Point = tuple[float, float]

CONTACT = 1e-9
"""Shapes no farther apart than this touch [mm], and a margin missed by less is kept: a thousand times the rounding of
a double at the size of a table."""


@dataclass(frozen=True, slots=True)
class Shape:
    """A disc (no vertices) or a convex polygon (counter-clockwise) in the table frame [mm].

    `x`, `y`, `radius`: a circle around it, which is the disc itself where it is one.
    """

    x: float
    y: float
    radius: float
    vertices: tuple[Point, ...] = ()


def disc(x: float, y: float, radius: float) -> Shape:
    """Return the disc around (x, y)."""
    return Shape(x, y, radius)


def polygon(vertices: tuple[Point, ...]) -> Shape:
    """Return the convex polygon with these counter-clockwise corners."""
    xs, ys = [p[0] for p in vertices], [p[1] for p in vertices]
    if math.isnan(sum(xs) + sum(ys)):
        return Shape(math.nan, math.nan, math.nan, vertices)
    x, y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    return Shape(x, y, max(math.hypot(px - x, py - y) for px, py in vertices), vertices)


def rectangle(x: tuple[float, float], y: tuple[float, float]) -> Shape:
    """Return the axis-parallel rectangle between these bounds."""
    return polygon(((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])))


def placed(footprint: Footprint, pose: Pose) -> Shape:
    """Return `footprint` standing at `pose`."""
    vertices = tuple(pose.apply(*corner) for corner in footprint.vertices)
    return Shape(pose.x, pose.y, footprint.radius, vertices)


def moved(shape: Shape, dx: float, dy: float) -> Shape:
    """Return `shape` shifted by (dx, dy)."""
    return Shape(shape.x + dx, shape.y + dy, shape.radius, tuple((x + dx, y + dy) for x, y in shape.vertices))


def separation(a: Shape, b: Shape) -> float:
    """Return the distance between two shapes [mm]; where they overlap, minus the least shift that parts them.

    Exact for discs and convex polygons, symmetric, zero where they touch. For polygons the least shift is along a
    normal of one of the edges (the edges of their Minkowski difference).
    """
    if not a.vertices and not b.vertices:
        return math.hypot(a.x - b.x, a.y - b.y) - (a.radius + b.radius)
    if not a.vertices:
        return _point_to_polygon(a.x, a.y, b.vertices) - a.radius
    if not b.vertices:
        return _point_to_polygon(b.x, b.y, a.vertices) - b.radius
    depth = max(_along_normals(a.vertices, b.vertices), _along_normals(b.vertices, a.vertices))
    if depth <= 0:
        return depth
    return min(_corners_to_edges(a.vertices, b.vertices), _corners_to_edges(b.vertices, a.vertices))


def conflict(a: Shape, b: Shape, margin: float = 0.0) -> bool:
    """Return whether two shapes come nearer than `margin` [mm]; touching counts, and so does what is not a number."""
    gap = math.hypot(a.x - b.x, a.y - b.y) - (a.radius + b.radius)
    enough = max(CONTACT, margin - CONTACT)
    if gap > enough:
        return False
    return math.isnan(gap) or not separation(a, b) > enough


def _along_normals(a: tuple[Point, ...], b: tuple[Point, ...]) -> float:
    """Return how far `b` lies outside `a` along the best of the outward edge normals of `a`."""
    best = -math.inf
    ax, ay = a[-1]
    for bx, by in a:
        nx, ny = by - ay, ax - bx
        length = math.hypot(nx, ny)
        if length > 0:
            best = max(best, min((px - ax) * nx + (py - ay) * ny for px, py in b) / length)
        ax, ay = bx, by
    return best


def _corners_to_edges(a: tuple[Point, ...], b: tuple[Point, ...]) -> float:
    return min(_edge_distance(px, py, b) for px, py in a)


def _edge_distance(px: float, py: float, corners: tuple[Point, ...]) -> float:
    """Return the distance from a point to the outline of a polygon."""
    best = math.inf
    ax, ay = corners[-1]
    for bx, by in corners:
        ex, ey = bx - ax, by - ay
        square = ex * ex + ey * ey
        t = ((px - ax) * ex + (py - ay) * ey) / square if square > 0 else 0.0
        t = min(1.0, max(0.0, t))
        best = min(best, math.hypot(px - ax - t * ex, py - ay - t * ey))
        ax, ay = bx, by
    return best


def _point_to_polygon(px: float, py: float, corners: tuple[Point, ...]) -> float:
    """Return the signed distance from a point to a polygon, negative inside."""
    outside = _along_normals(corners, ((px, py),))
    return outside if outside <= 0 else _edge_distance(px, py, corners)


@lru_cache(maxsize=4096)
def half_turn_symmetric(footprint: Footprint) -> bool:
    """Return whether half a turn leaves the footprint as it is."""
    corners = footprint.vertices
    return all(any(math.hypot(x + u, y + v) < 1e-6 for u, v in corners) for x, y in corners)
