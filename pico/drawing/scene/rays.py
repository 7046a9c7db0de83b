"""The light of a scene: straight pieces with their power, polarization, radius and colour."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from pico.drawing.beams import standing
from pico.model.setup import Setup
from pico.optics.axis import Values
from pico.twin.placement import Placement

_BANDS = (
    (380, (0.45, 0.0, 0.55)), (440, (0.0, 0.0, 1.0)), (490, (0.0, 1.0, 1.0)), (510, (0.0, 1.0, 0.0)),
    (580, (1.0, 1.0, 0.0)), (645, (1.0, 0.0, 0.0)), (780, (0.55, 0.0, 0.0)),
)  # fmt: skip
"""Wavelength [nm] and colour of points between which colours are mixed (after D. Bruton, 1996)."""


def color_of(wavelength: float) -> list[float]:
    """Return a colour (red, green, blue, 0 to 1) for a wavelength [nm]; what nobody sees looks as the nearest end."""
    at = min(max(wavelength, _BANDS[0][0]), _BANDS[-1][0])
    for (low, a), (high, b) in pairwise(_BANDS):
        if at <= high:
            share = (at - low) / (high - low)
            return [round(p + share * (q - p), 3) for p, q in zip(a, b, strict=True)]
    raise AssertionError("it is within the bands")


def segments(setup: Setup, places: Mapping[str, Placement], values: Values) -> list[dict[str, Any]]:
    """Return the pieces of the beams of all sources [mm, mW, nm, deg]; `lit` where the source shines now, else it is
    the way that its light would go. `before`: the number of the piece that it comes from."""
    from pico.optics.beam_table import rows
    from pico.optics.light import is_dark, light_of

    light = light_of(setup, standing(places), values, lit=lambda _: True)
    found = []
    for row, crossing in zip(rows(light), light.crossings, strict=True):
        begun = 0.0 if row.before is None else light.crossings[row.before].beam.length
        start = crossing.beam.at - (crossing.beam.length - begun) * crossing.beam.along
        wavelength = crossing.beam.wavelength * 1e6
        found.append({
            "source": row.source, "component": row.component, "event": row.event, "before": row.before,
            "start": _rounded(start.tolist()), "end": _rounded(row.at), "lit": not is_dark(values.get(row.source, {})),
            "power": _figures(row.power), "onward": _figures(row.onward), "clipped": _figures(row.clipped),
            "radii": _rounded(row.radii), "wavelength": round(wavelength, 3), "color": color_of(wavelength),
            "polarization": {
                "angle": round(row.angle, 3), "ellipticity": round(row.ellipticity, 4), "degree": round(row.degree, 4),
            },
            "ghost": row.ghost,
        })  # fmt: skip
    return found


def _rounded(values: Any) -> list[float]:
    return [round(float(v), 4) for v in values]


def _figures(value: float) -> float:
    return float(f"{value:.5g}")
