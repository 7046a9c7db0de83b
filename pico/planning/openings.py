"""How far irises are opened for a ready-made goal."""

from __future__ import annotations

from pico.planning.asked import Asked

_RADII = 1.0
"""Beam radii to which an iris is stopped down: narrow enough for its middle to be sharp, wide enough for light."""


def wide_open(asked: Asked, iris: str) -> float:
    """Return the widest opening of an iris [mm]."""
    bounds = asked.setup.type_of(iris).tunables["opening"].range
    return bounds[1] if bounds else 0.0


def stopped_down(asked: Asked, iris: str) -> float:
    """Return the opening of an iris by which a beam that meets it is centred [mm]: about as wide as the beam."""
    from pico.optics.light import light_of

    light = light_of(asked.setup, asked.poses, asked.values, lit=lambda _: True)
    radius = max((c.beam.widths[0] for c in light.crossings if c.component == iris), default=0.5)
    low, high = asked.setup.type_of(iris).tunables["opening"].range or (0.0, 2 * radius)
    return round(min(max(2 * _RADII * radius, low), high / 2), 2)
