"""What elements do to a chief ray by geometry alone, one record each: what `pico.optics.axis` knows of them.

It must say what the file of `pico.optics.elements` that bears the name does with light, and imports nothing heavy: who
plans follows rays, not fields. An element that is not here passes light straight on, from either side.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

from pico.model.catalog import ComponentType

Vector = tuple[float, float, float]
Event = Literal["passed", "reflected", "divided", "detected", "blocked", "left"]
Kick = tuple[float, float, bool]
"""By how much the part of a direction that lies in an element changes along its local left: always, and per mm of
wavelength; and whether it is sent back."""


@dataclass(frozen=True, slots=True)
class Struck:
    """A ray of a `wavelength` [mm] at an element: where [mm], in which direction; the element's center [mm] and normal,
    its local left, and its kicks."""

    at: Vector
    towards: Vector
    center: Vector
    normal: Vector
    left: Vector
    wavelength: float
    kicks: tuple[Kick, ...]


Ways = Callable[[Struck], list[tuple[Vector, Vector]]]
"""Where rays go on from [mm], and in which direction."""


@dataclass(frozen=True, slots=True)
class Geometry:
    """What becomes of a ray at an element. `face`: along which side of its normal light must come, None from either;
    `faces_back`: its face looks along local -x; `turns`: its tunables tip and tilt count; `folds`: its normal stands
    half way to `fold` degrees from what comes along +x; `cube`: it is as open on each side of a cube; `across`: a
    picture joins where light comes to it and where it goes on from. `kicks`: of a type."""

    event: Event = "passed"
    face: float | None = None
    faces_back: bool = False
    turns: bool = False
    folds: bool = False
    cube: bool = False
    across: bool = False
    ways: Ways = lambda struck: []
    kicks: Callable[[ComponentType], tuple[Kick, ...]] = lambda kind: ()


def geometry_of(element: str) -> Geometry:
    """Return what an element does to a ray."""
    return _ELEMENTS.get(element, _PASSES)


def mirrored(struck: Struck) -> list[tuple[Vector, Vector]]:
    """Return a ray as a plane mirror sends it back."""
    facing = 2 * _dot(struck.towards, struck.normal)
    return [(struck.at, _sum(struck.towards, _times(struck.normal, -facing)))]


def half_turned(vector: Vector) -> Vector:
    """Return a vector turned by half a turn about the upright: what two upright mirrors at a right angle make of a
    direction, and of where a ray meets the plane through their edge, so that the way there and back is as long."""
    return -vector[0], -vector[1], vector[2]


def _divided(struck: Struck) -> list[tuple[Vector, Vector]]:
    return [(struck.at, struck.towards), *mirrored(struck)]


def _roof(struck: Struck) -> list[tuple[Vector, Vector]]:
    offset = _sum(struck.at, _times(struck.center, -1.0))
    return [(_sum(struck.center, half_turned(offset)), half_turned(struck.towards))]


def _corner(struck: Struck) -> list[tuple[Vector, Vector]]:
    return [(_sum(_times(struck.center, 2.0), _times(struck.at, -1.0)), _times(struck.towards, -1.0))]


def kicked(struck: Struck) -> list[tuple[Vector, Vector]]:
    """Return a ray behind an element that adds to its direction along itself: an order of a grating, d' = d + m g
    wavelength in its plane. Orders that do not leave it are left out."""
    found = []
    facing = _dot(struck.towards, struck.normal)
    for always, per_wavelength, back in struck.kicks:
        inside = _sum(struck.towards, _times(struck.normal, -facing))
        inside = _sum(inside, _times(struck.left, always + per_wavelength * struck.wavelength))
        square = 1 - _dot(inside, inside)
        if square > GRAZING:
            out = math.copysign(math.sqrt(square), -facing if back else facing)
            found.append((struck.at, _sum(inside, _times(struck.normal, out))))
    return found


GRAZING = 1e-4
"""Square of the cosine below which nothing leaves a grating."""


def wollaston_kicks(kind: ComponentType) -> tuple[Kick, ...]:
    """Return how a Wollaston prism turns level and upright polarization: each half of `divergence`."""
    half = math.sin(math.radians((kind.number("divergence", "deg") or 0.0) / 2))
    return (half, 0.0, False), (-half, 0.0, False)


def grating_kicks(kind: ComponentType) -> tuple[Kick, ...]:
    """Return the orders of a reflection grating that have an efficiency, in the order of `ORDERS`."""
    lines = kind.number("lines", "1/mm") or 0.0
    return tuple((0.0, order * lines, True) for name, order in ORDERS.items() if kind.number(name, ""))


ORDERS: Mapping[str, int] = {"efficiency_0": 0, "efficiency_plus_1": 1, "efficiency_minus_1": -1}
"""Parameters of a grating, and the orders of which they are the shares of the power."""

_PASSES = Geometry()
_ELEMENTS: Mapping[str, Geometry] = {
    "beam_splitter": Geometry("divided", folds=True, cube=True, ways=_divided),
    "detector": Geometry("detected", face=1.0),
    "grating": Geometry("divided", face=-1.0, faces_back=True, ways=kicked, kicks=grating_kicks),
    "mirror": Geometry("reflected", face=-1.0, faces_back=True, turns=True, ways=mirrored),
    "parabola": Geometry("reflected", face=-1.0, folds=True, ways=mirrored),
    "plate_splitter": Geometry("divided", faces_back=True, turns=True, ways=_divided),
    "prism": Geometry("reflected", face=-1.0, folds=True, cube=True, ways=mirrored),
    "retroreflector": Geometry("reflected", face=-1.0, faces_back=True, across=True, ways=_corner),
    "roof_mirror": Geometry("reflected", face=-1.0, faces_back=True, across=True, ways=_roof),
    "wollaston": Geometry("divided", ways=kicked, kicks=wollaston_kicks),
}
MIRRORS = tuple(name for name, geometry in _ELEMENTS.items() if geometry.faces_back)
"""Elements whose face looks along local -x."""


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _sum(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _times(a: Vector, by: float) -> Vector:
    return a[0] * by, a[1] * by, a[2] * by
