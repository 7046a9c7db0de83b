"""Convex shapes for the second collision check, and distances between them that carry their own proof. In metres.

The GJK of fcl, like any, stops now and then (2 % of the pairs with a cylinder) before it is at the nearest points and
gives a distance that is too great, by 10 mm in the worst case seen. So a distance counts only as far as the plane
across its two points separates the shapes, which their support functions tell exactly.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from pico.model.body import Body
from pico.model.catalog import Geometry
from pico.motion.shapes import LinkShape

Array = Any
"""A numpy array of floats."""

_THINNEST = 1e-4  # m, what is left of a shape that is thinner than what is taken off
_NUDGE = 2e-5  # m, a shifted start does not stop at the same place


@dataclass(frozen=True, eq=False)
class Hull:
    """A box, cylinder or capsule (along its z), or a prism of `corners`, at `center` in the frame of what it is of.

    `half`: half-lengths of a box and of the box around a prism; (radius, radius, half-length) of the others, of a
    capsule without its caps [m]. `turn` is the rotation matrix into the frame of what it is of.
    """

    part: str
    kind: Literal["box", "cylinder", "capsule", "prism"]
    half: tuple[float, float, float]
    center: Array
    turn: Array
    corners: tuple[tuple[float, float, float], ...] = ()

    @property
    def radius(self) -> float:
        """The distance of the farthest point from the center, at most [m]."""
        r, _, h = self.half
        if self.kind == "capsule":
            return r + h
        return math.hypot(r, h) if self.kind == "cylinder" else math.hypot(*self.half)

    def extent(self, turn: Array) -> Array:
        """Return half-lengths (..., 3) along the axes of the box around the shape, turned by `turn` (..., 3, 3)."""
        r, _, h = self.half
        if self.kind == "capsule":
            return r + h * np.abs(turn[..., 2])
        if self.kind == "cylinder":
            return r * np.sqrt(turn[..., 0] ** 2 + turn[..., 1] ** 2) + h * np.abs(turn[..., 2])
        return np.abs(turn) @ np.array(self.half)

    def support(self, n: Sequence[float]) -> float:
        """Return how far the shape reaches from its center along the unit vector `n` of its own frame [m]."""
        x, y, z = n
        a, b, c = self.half
        if self.kind == "box":
            return a * abs(x) + b * abs(y) + c * abs(z)
        if self.kind == "cylinder":
            return a * math.hypot(x, y) + c * abs(z)
        if self.kind == "capsule":
            return a + c * abs(z)
        return max(x * u + y * v + z * w for u, v, w in self.corners)

    @cached_property
    def shape(self) -> Any:
        """The shape as fcl has it."""
        import fcl

        a, b, c = self.half
        if self.kind == "box":
            return fcl.Box(2 * a, 2 * b, 2 * c)
        if self.kind == "cylinder":
            return fcl.Cylinder(a, 2 * c)
        if self.kind == "capsule":
            return fcl.Capsule(a, 2 * c)
        faces = _faces(len(self.corners) // 2)
        flat = [value for face in faces for value in (len(face), *face)]
        return fcl.Convex(np.array(self.corners), len(faces), np.array(flat))


class Placed:
    """A hull that fcl can measure from: put it somewhere with `put`."""

    def __init__(self, hull: Hull) -> None:
        import fcl

        self.hull = hull
        self._fcl = fcl
        self.object = fcl.CollisionObject(hull.shape)
        self.put(np.eye(3), np.zeros(3))

    def put(self, turn: Array, center: Array) -> Placed:
        """Place the hull's own frame."""
        self.turn, self.center = turn, center
        self.object.setTransform(self._fcl.Transform(turn, center))
        return self


def distance(one: Placed, other: Placed, enough: float) -> float:
    """Return a proven lower bound of the distance of two hulls [m], zero where they meet; where the first one is below
    `enough` the best of several, which is the distance itself to 0.05 mm."""
    best = 0.0
    for look in (
        lambda: _proven(one, other),
        lambda: _along_axes(one, other),
        lambda: _proven(other, one),
        *(_nudged(one, other, _NUDGE * axis) for axis in np.eye(3)),
    ):
        best = max(best, look() or 0.0)  # where fcl sees them meet it may be wrong, a plane between them is not
        if best >= enough:
            break
    return best


def _along_axes(one: Placed, other: Placed) -> float:
    """Return by how much a plane along the axes of either hull's own frame separates the two; negative for none."""
    axes = [sign * axis for turn in (one.turn, other.turn) for axis in turn.T for sign in (1.0, -1.0)]
    return max(_apart(one, other, n) for n in axes)


def _apart(one: Placed, other: Placed, n: Array) -> float:
    """Return how much room two hulls leave along the unit vector `n`, from the first to the second; negative: none."""
    mine, its = (n @ one.turn).tolist(), (-n @ other.turn).tolist()
    return float(n @ (other.center - one.center)) - one.hull.support(mine) - other.hull.support(its)


def _nudged(one: Placed, other: Placed, nudge: Array) -> Any:
    def look() -> float | None:
        center = other.center
        other.put(other.turn, center + nudge)
        bound = _proven(one, other)
        other.put(other.turn, center)
        return bound - _NUDGE if bound is not None else None

    return look


def _proven(one: Placed, other: Placed) -> float | None:
    """Return by how much the plane across the nearest points that fcl finds separates the hulls; None: they meet."""
    import fcl

    result = fcl.DistanceResult()
    found = fcl.distance(one.object, other.object, fcl.DistanceRequest(enable_nearest_points=True), result)
    if found <= 0.0:
        return None
    p, q = result.nearest_points
    return _apart(one, other, (q - p) / max(float(np.linalg.norm(q - p)), 1e-12))


def of_shapes(part: str, shapes: Iterable[LinkShape], inset: float) -> list[Hull]:
    """Return hulls of the colliding `shapes` of one link, in the link's frame, each `inset` metres smaller."""
    hulls = []
    for shape in shapes:
        if not shape.collides:
            continue
        a, b = np.array(shape.a) / 1000, np.array(shape.b) / 1000
        if shape.kind == "box":
            half = _smaller(tuple(b), inset)
            hulls.append(Hull(part, "box", half, a, np.eye(3)))
            continue
        length, radius = float(np.linalg.norm(b - a)), shape.radius / 1000
        along = (b - a) / length
        if shape.kind == "capsule":
            half = (max(radius - inset, _THINNEST), 0.0, length / 2)
        else:
            r, h = max(radius - inset, _THINNEST), max(length / 2 - inset, _THINNEST)
            half = (r, r, h)
        kind: Literal["capsule", "cylinder"] = "capsule" if shape.kind == "capsule" else "cylinder"
        hulls.append(Hull(part, kind, half, (a + b) / 2, _turn_of_z(along)))
    return hulls


def of_geometry(part: str, geometry: Geometry, inset: float = 0.0) -> list[Hull]:
    """Return hulls of a component in its own frame: its bodies, else its footprint drawn up to its height."""
    if geometry.bodies:
        return [_of_body(part, body, inset) for body in geometry.bodies]
    footprint, height = geometry.footprint, geometry.height / 1000
    middle = np.array((0.0, 0.0, height / 2))
    if footprint.disc is not None:
        r = footprint.disc / 1000
        return [Hull(part, "cylinder", _smaller((r, r, height / 2), inset), middle, np.eye(3))]
    if footprint.box is not None:
        x, y = (v / 2000 for v in footprint.box)
        return [Hull(part, "box", _smaller((x, y, height / 2), inset), middle, np.eye(3))]
    return [_prism(part, footprint.vertices, height, inset)]


def _of_body(part: str, body: Body, inset: float) -> Hull:
    center, c, s = np.array(body.at) / 1000, math.cos(math.radians(body.yaw)), math.sin(math.radians(body.yaw))
    turn = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    if body.shape == "box":
        x, y, z = (v / 2000 for v in body.size)
        return Hull(part, "box", _smaller((x, y, z), inset), center, turn)
    r, h = body.size[0] / 2000, body.size[1] / 2000
    along = {"x": turn[:, 0], "y": turn[:, 1], "z": turn[:, 2]}[body.axis]
    return Hull(part, "cylinder", _smaller((r, r, h), inset), center, _turn_of_z(along))


def _prism(part: str, outline: Sequence[tuple[float, float]], height: float, inset: float) -> Hull:
    """A polygon drawn up; every edge is moved inward by `inset` or more."""
    flat = np.array(outline) / 1000
    inside, along = flat.mean(axis=0), np.roll(flat, -1, axis=0) - flat
    across = np.abs(along[:, 0] * (flat - inside)[:, 1] - along[:, 1] * (flat - inside)[:, 0])
    nearest = float((across / np.hypot(along[:, 0], along[:, 1])).min())
    flat = inside + (flat - inside) * max(1.0 - inset / nearest, 0.01)
    low, high = flat.min(axis=0), flat.max(axis=0)
    middle, h = (low + high) / 2, max(height / 2 - inset, _THINNEST)
    corners = tuple((float(x), float(y), z) for z in (-h, h) for x, y in flat - middle)
    x, y = ((high - low) / 2).tolist()
    return Hull(part, "prism", (x, y, h), np.array((*middle, height / 2)), np.eye(3), corners)


def _faces(n: int) -> list[list[int]]:
    """Faces of a prism of n corners below and n above, seen from outside counter-clockwise."""
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return [list(range(n - 1, -1, -1)), list(range(n, 2 * n)), *sides]


def _smaller(half: tuple[float, ...], inset: float) -> tuple[float, float, float]:
    x, y, z = (max(v - inset, _THINNEST) for v in half)
    return x, y, z


def _turn_of_z(along: Array) -> Array:
    """A rotation matrix whose third column is `along`."""
    helper = np.array((1.0, 0.0, 0.0)) if abs(along[0]) < 0.9 else np.array((0.0, 1.0, 0.0))
    x = np.cross(helper, along)
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(along, x), along))
