"""Rays through surfaces, exact in three dimensions: where they meet a plane or a sphere, and how they go on.

Sequential: `trace` takes the surfaces in order. What comes next on a table is for `pico.optics.axis` to say. Lengths
are in mm, in any one frame; directions have length 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_NEAR = 1e-9  # mm: what a ray has just left


@dataclass(frozen=True, eq=False)
class Surface:
    """A plane or a sphere with a round edge.

    `vertex` (3,) [mm]; `normal` (3,), of length 1, at the vertex; `curvature`: 1/R [1/mm], positive where the center of
    the sphere lies on the side that the normal points to; `radius` of the edge [mm]. `before` and `after`: refractive
    indices on the side that the normal points away from, and on the one that it points to. `reflects`: a mirror.
    `form` (3, 3): how a surface that is no sphere bends to where its normal points, around a vertex at which the chief
    ray meets it [1/mm]; what is Gaussian around that follows it, not rays beside it.
    """

    vertex: Array
    normal: Array
    curvature: float = 0.0
    radius: float = np.inf
    before: float = 1.0
    after: float = 1.0
    reflects: bool = False
    form: Array | None = None


@dataclass(frozen=True, eq=False)
class Rays:
    """Rays: points (n, 3) [mm], directions (n, 3), optical path so far (n,) [mm], and whether each is still there."""

    at: Array
    along: Array
    path: Array
    alive: NDArray[np.bool_]


def rays(at: Any, along: Any) -> Rays:
    """Return rays that begin at points (n, 3) [mm] and go in directions (n, 3), of any length."""
    points = np.atleast_2d(np.asarray(at, dtype=float))
    ways = np.atleast_2d(np.asarray(along, dtype=float))
    ways = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    return Rays(points, ways, np.zeros(len(points)), np.ones(len(points), dtype=bool))


def trace(surfaces: Sequence[Surface], begun: Rays) -> list[Rays]:
    """Return the rays behind each surface, in order; who misses one, or is totally reflected, is not `alive` there."""
    found = []
    for surface in surfaces:
        begun = cross(surface, begun)
        found.append(begun)
    return found


def cross(surface: Surface, begun: Rays) -> Rays:
    """Return rays where they leave a surface; the first meeting with the cap of a sphere that holds its vertex."""
    far, met = _distance(surface, begun)
    at = begun.at + far[:, None] * begun.along
    square = ((at - surface.vertex) ** 2).sum(axis=1)
    depth = (at - surface.vertex) @ surface.normal
    alive = begun.alive & met & (square - depth**2 <= surface.radius**2)
    normals = surface.normal - surface.curvature * (at - surface.vertex)
    normals = normals / np.sqrt((normals**2).sum(axis=1))[:, None]
    facing = (begun.along * normals).sum(axis=1)
    onward = facing >= 0
    index = np.where(onward, surface.before, surface.after)
    if surface.reflects:
        along = begun.along - 2 * facing[:, None] * normals
    else:
        along, whole = _refracted(begun.along, normals, facing, index / np.where(onward, surface.after, surface.before))
        alive = alive & ~whole
    return Rays(at, along, begun.path + index * far, alive)


def cross_alone(surface: Surface, at: Array, along: Array) -> tuple[Array, Array] | None:
    """Return the point (3,) where one ray of direction `along`, of length 1, leaves a surface, and how it goes on; None
    where it misses it or is totally reflected. The same as `cross`, in a tenth of the time."""
    (px, py, pz), (vx, vy, vz) = at.tolist(), surface.vertex.tolist()
    (x, y, z), (nx, ny, nz) = along.tolist(), surface.normal.tolist()
    c, ox, oy, oz = surface.curvature, px - vx, py - vy, pz - vz
    height, facing = ox * nx + oy * ny + oz * nz, x * nx + y * ny + z * nz
    half = facing - c * (ox * x + oy * y + oz * z)
    rest = c * (ox * ox + oy * oy + oz * oz) - 2 * height
    root = half * half - c * rest
    if root < 0 or abs(facing) <= 1e-12:
        return None
    aside = math.copysign(math.sqrt(root), facing)
    far = rest / (half + aside) if half * facing > 0 else (half - aside) / c
    if far <= -_NEAR or c * (height + far * facing) >= 1:
        return None
    ox, oy, oz = ox + far * x, oy + far * y, oz + far * z
    depth = ox * nx + oy * ny + oz * nz
    if ox * ox + oy * oy + oz * oz - depth * depth > surface.radius**2:
        return None
    nx, ny, nz = nx - c * ox, ny - c * oy, nz - c * oz
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / size, ny / size, nz / size
    facing = x * nx + y * ny + z * nz
    if surface.reflects:
        ratio, bend = 1.0, -2 * facing
    else:
        ratio = surface.before / surface.after if facing >= 0 else surface.after / surface.before
        square = 1 - ratio * ratio * (1 - facing * facing)
        if square < 0:
            return None
        bend = math.copysign(math.sqrt(square), facing) - ratio * facing
    on = np.array([ratio * x + bend * nx, ratio * y + bend * ny, ratio * z + bend * nz])
    return np.array([ox + vx, oy + vy, oz + vz]), on


def _distance(surface: Surface, begun: Rays) -> tuple[Array, NDArray[np.bool_]]:
    """Return how far ahead (n,) [mm] rays meet a surface, and whether they do.

    Of the two points of a sphere that is the one on the vertex's side of its center: c z < 1.
    """
    offset = begun.at - surface.vertex
    height = offset @ surface.normal
    facing = begun.along @ surface.normal
    c = surface.curvature
    # c |p|^2 - 2 z = 0 for a point p = offset + far along, with z = p . normal
    half = facing - c * (offset * begun.along).sum(axis=1)
    rest = c * (offset**2).sum(axis=1) - 2 * height
    root = half**2 - c * rest
    aside = np.copysign(np.sqrt(np.maximum(root, 0.0)), facing)  # = normal at the point . along
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.where(half * facing > 0, rest / (half + aside), (half - aside) / c)
    far = np.where(np.isfinite(far), far, 0.0)
    cap = c * (height + far * facing) < 1
    return far, (root >= 0) & cap & (np.abs(facing) > 1e-12) & (far > -_NEAR)


def _refracted(along: Array, normals: Array, facing: Array, ratio: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return directions behind a surface by Snell's law, as vectors, and which rays it reflects totally. `ratio`: the
    index before over the one behind."""
    square = 1 - ratio**2 * (1 - facing**2)
    inside = np.copysign(np.sqrt(np.maximum(square, 0.0)), facing)
    return ratio[:, None] * along + (inside - ratio * facing)[:, None] * normals, square < 0
