"""Refractive indices of glasses by wavelength: Sellmeier's equation, n^2 = 1 + sum of B w^2 / (w^2 - C), w in um.

Coefficients of N-BK7 and N-SF11 are those of Schott's data sheets, of fused silica those of Malitson (1965), of CaF2
those of Malitson (1963). Of air 1 is taken, as in `pico.optics`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

DESIGN = 632.8
"""The wavelength at which a type's index and focal length hold, if it does not say another one [nm]."""


@dataclass(frozen=True)
class Glass:
    """`b` and `c` [um^2] of Sellmeier's equation, and the wavelengths between which they hold [nm]."""

    b: tuple[float, float, float]
    c: tuple[float, float, float]
    span: tuple[float, float]


GLASSES: Mapping[str, Glass] = {
    "N-BK7": Glass(
        (1.03961212, 0.231792344, 1.01046945), (0.00600069867, 0.0200179144, 103.560653), (300.0, 2500.0)
    ),
    "N-SF11": Glass(
        (1.73759695, 0.313747346, 1.89878101), (0.013188707, 0.0623068142, 155.23629), (370.0, 2500.0)
    ),
    "fused silica": Glass(
        (0.6961663, 0.4079426, 0.8974794), (0.0684043**2, 0.1162414**2, 9.896161**2), (210.0, 3710.0)
    ),
    "CaF2": Glass((0.5675888, 0.4710914, 3.8484723), (0.050263605**2, 0.1003909**2, 34.64904**2), (230.0, 9700.0)),
}  # fmt: skip


def index(glass: str, wavelength: float) -> float:
    """Return the refractive index of a glass at a wavelength in vacuum [nm]; beyond its span that at the end of it.
    Raises KeyError for an unknown glass."""
    known = GLASSES[glass]
    square = (min(max(wavelength, known.span[0]), known.span[1]) * 1e-3) ** 2
    return math.sqrt(1 + sum(b * square / (square - c) for b, c in zip(known.b, known.c, strict=True)))


def index_at(glass: str, given: float, design: float, wavelength: float) -> float:
    """Return the index at a wavelength [nm] of a glass that has a `given` one at the `design` wavelength [nm]; that
    one, if the glass is unknown."""
    if glass not in GLASSES:
        return given
    return given + index(glass, wavelength) - index(glass, design)
