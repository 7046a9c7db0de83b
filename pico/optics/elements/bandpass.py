"""A bandpass filter: it passes the wavelengths around its center."""

from __future__ import annotations

import math

from pico.optics.beam import Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate
from pico.optics.rays import Surface
from pico.optics.strays import astray, passing


def meet(part: Part, beam: Beam) -> Met:
    """Pass the share `transmission` of what is within half the `bandwidth` of `center_wavelength`, and 10^-`blocking`
    of the rest. The center is at shorter wavelengths where the filter is tilted, as its layers have it: times
    (1 - sin^2 / n^2)^1/2 with the `effective_index` n."""
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
    sine = math.sqrt(max(0.0, 1 - float(came.along @ part.axes[0]) ** 2))
    shift = math.sqrt(1 - (sine / part.number("effective_index", "", 2.0)) ** 2)
    wavelength = came.wavelength * 1e6
    off = abs(wavelength - part.number("center_wavelength", "nm", wavelength) * shift)
    within = off <= part.number("bandwidth", "nm", math.inf) / 2
    return part.number("transmission", "", 1.0) if within else 10 ** -part.number("blocking", "", 4.0)
