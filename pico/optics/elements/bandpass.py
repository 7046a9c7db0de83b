"""A bandpass filter: it passes the wavelengths around its center."""

from __future__ import annotations

import math

from pico.model.materials.ranges import band
from pico.optics.beam import Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate
from pico.optics.rays import Surface
from pico.optics.strays import astray, passing


def meet(part: Part, beam: Beam) -> Met:
    """Pass the share `transmission` of what is within its band (see `band`), and 10^-`blocking` of the rest."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    return Met(came, plate(part, scaled(passed, math.sqrt(_share(part, came)))), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its layers send back: all that they do not pass."""
    back = math.sqrt(1 - _share(part, met.came))
    mirror = Surface(part.center, part.axes[0])
    return astray(beyond(passing(met), mirror, reflect=True, amplitudes=lambda _: (back, back)))


def _share(part: Part, came: Beam) -> float:
    """Return the share of the power that passes."""
    own, wavelength = band(part.kind, float(came.along @ part.axes[0])), came.wavelength * 1e6
    within = own is None or own[0] <= wavelength <= own[1]
    return part.number("transmission", "", 1.0) if within else 10 ** -part.number("blocking", "", 4.0)
