"""Where the mass of a component is taken to be: in its housing, most of it in what stands on the table. mm, kg."""

from __future__ import annotations

import math

from pico.model.body import Body
from pico.model.catalog import Footprint, Geometry

BASE_SHARE = 0.6
"""Share of a component's mass that lies in what touches the table: magnetic bases are steel, the rest aluminum."""
_TOUCHES = 1.0  # mm
_PLAIN = (0.42, 0.44, 0.48, 1.0)


def bodies_of(geometry: Geometry) -> tuple[Body, ...]:
    """Return the housing's shapes; where the type names none, one that fills footprint and height."""
    if geometry.bodies:
        return geometry.bodies
    print_, height = geometry.footprint, geometry.height
    if print_.disc is not None:
        size: tuple[float, ...] = (2 * print_.disc, height)
        return (Body(name="body", shape="cylinder", size=size, at=(0, 0, height / 2), color=_PLAIN),)
    (x0, x1), (y0, y1) = _extent(print_)
    at = ((x0 + x1) / 2, (y0 + y1) / 2, height / 2)
    return (Body(name="body", shape="box", size=(x1 - x0, y1 - y0, height), at=at, color=_PLAIN),)


def masses(geometry: Geometry, shapes: tuple[Body, ...]) -> tuple[float, ...]:
    """Return the mass of each of `shapes` [kg]: most of it in what touches the table, so that the part stands, the
    rest by volume."""
    low = [touches(shape) for shape in shapes]
    share = {True: BASE_SHARE, False: 1 - BASE_SHARE} if any(low) and not all(low) else {True: 1.0, False: 1.0}
    totals = {side: sum(_volume(s) for s, at in zip(shapes, low, strict=True) if at is side) for side in (True, False)}
    return tuple(geometry.mass * share[at] * _volume(shape) / totals[at] for shape, at in zip(shapes, low, strict=True))


def center_of_mass(geometry: Geometry) -> tuple[float, float, float]:
    """Return the center of mass in the component's frame [mm]."""
    shapes = bodies_of(geometry)
    parts = masses(geometry, shapes) if geometry.mass else tuple(_volume(s) for s in shapes)
    total = sum(parts)
    x, y, z = (sum(m * s.at[axis] for m, s in zip(parts, shapes, strict=True)) / total for axis in range(3))
    return x, y, z


def touches(shape: Body) -> bool:
    """Return whether a shape stands on the table (1 mm)."""
    if shape.shape == "box":
        return shape.at[2] - shape.size[2] / 2 < _TOUCHES
    return shape.at[2] - (shape.size[1] if shape.axis == "z" else shape.size[0]) / 2 < _TOUCHES


def _extent(footprint: Footprint) -> tuple[tuple[float, float], tuple[float, float]]:
    xs, ys = zip(*footprint.vertices, strict=True)
    return (min(xs), max(xs)), (min(ys), max(ys))


def _volume(shape: Body) -> float:
    return math.prod(shape.size) if shape.shape == "box" else math.pi / 4 * shape.size[0] ** 2 * shape.size[1]
