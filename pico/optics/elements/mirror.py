"""A mirror: it sends a beam back from its face, s and p each with an amplitude of its own."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Amplitudes, Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import fresnel
from pico.optics.rays import Surface
from pico.optics.strays import astray, passing


def meet(part: Part, beam: Beam) -> Met:
    """Reflect a beam, off a sphere where its type has a `radius_of_curvature`, above 0 where that is hollow."""
    normal = np.array(part.optic.normal)
    came = arrived(part, beam, normal=normal)
    passed, lost = clipped(part, came, part.optic.radius)
    radius = part.kind.number("radius_of_curvature", "mm")
    if radius:  # away from its middle the face lies before or behind the plane at which the beam came
        curved = Surface(part.center, normal, 1 / radius)
        sent = beyond(scaled(beam, math.sqrt(1 - lost)), curved, reflect=True, amplitudes=amplitudes(part))
        return Met(came, (replace(sent, unknown=passed.unknown),) if sent else (), lost)
    sent = beyond(passed, Surface(part.center, normal), reflect=True, amplitudes=amplitudes(part))
    return Met(came, (sent,) if sent else (), lost)


def amplitudes(part: Part) -> Amplitudes:
    """Return r_s and r_p for the cosine of incidence: of a metal where the type gives `refractive_index` and
    `extinction_coefficient`; else of its `reflectance`, with `retardance` of p after s [deg]."""
    n, k = (part.kind.number(name, "") for name in ("refractive_index", "extinction_coefficient"))
    if n is not None and k is not None:
        metal = complex(n, k)
        return lambda cosine: fresnel(1.0, metal, cosine)[:2]
    size = math.sqrt(part.number("reflectance", "", 1.0))
    late = cmath.exp(1j * math.radians(part.number("retardance", "deg", 0.0)))
    return lambda cosine: (-size, size * late)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what passes a mirror: its `transmittance`, none where its type does not say."""
    share = part.number("transmittance", "", 0.0)
    return astray(scaled(passing(met), math.sqrt(share))) if share else ()
