"""A wave plate, turned about its axis by the tunable `angle`: its fast axis is level at 0."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate
from pico.optics.polarization import Vector, product
from pico.optics.strays import of_plate


def meet(part: Part, beam: Beam) -> Met:
    """Hold back what is polarized across the fast axis by `retardance` waves at `design_wavelength`."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    _, left, up = part.axes
    angle = math.radians(part.value("angle", "deg", part.number("angle", "deg", 0.0)))
    wavelength = beam.wavelength * 1e6
    waves = part.number("retardance", "", 0.5) * part.number("design_wavelength", "nm", wavelength) / wavelength
    fast = math.cos(angle) * left + math.sin(angle) * up
    behind = scaled(retarded(passed, fast, 2 * math.pi * waves), math.sqrt(part.number("transmission", "", 1.0)))
    return Met(came, plate(part, behind), lost)


def retarded(beam: Beam, fast: Vector, phase: float) -> Beam:
    """Return a beam whose field across the fast axis comes later by a phase [rad]: times exp(i phase)."""
    seen = fast - (fast @ beam.along) * beam.along
    seen = seen / np.linalg.norm(seen)
    slow = product(beam.along, seen)
    early, late = cmath.exp(-0.5j * phase), cmath.exp(0.5j * phase)
    parts = ((w, w.field @ seen, w.field @ slow) for w in beam.waves)
    return replace(beam, waves=tuple(replace(w, field=early * a * seen + late * b * slow) for w, a, b in parts))


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back."""
    return of_plate(part, met)
