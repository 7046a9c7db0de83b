"""Two arms of an interferometer: how much longer one is than the other where their light meets, and over which
difference their fringes are seen."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.optics.coherence import coherence_length, spectra_of
from pico.optics.light import Arrival, Light


@dataclass(frozen=True)
class Meeting:
    """Two beams of one source on a detector. `delay`: by how much the path of the first is longer [mm], in the middle
    between the spots; `contrast`: the visibility of their fringes if both were as long; `length`: the difference of
    paths at which it has fallen to 1/e [mm], infinite where the source has a single frequency. Polarizations count as
    the same."""

    delay: float
    contrast: float
    length: float


def meeting(light: Light, detector: str) -> Meeting | None:
    """Return how the two beams meet that come to a detector; None where it is not two of one source."""
    arrivals = light.at(detector)
    if len(arrivals) != 2 or len({a.beam.source for a in arrivals}) != 1 or min(a.power for a in arrivals) <= 0:
        return None
    one, other = arrivals
    middle = (one.beam.at + other.beam.at) / 2
    delay = _path(one, middle) - _path(other, middle)
    source = light.parts[one.beam.source]
    length = coherence_length(spectra_of(source.kind, one.beam.wavelength * 1e6))
    radius = min(one.beam.widths[:2])
    away = one.beam.at - other.beam.at
    apart = float(np.linalg.norm(away - (away @ one.beam.along) * one.beam.along))
    contrast = 2 * math.sqrt(one.power * other.power) / (one.power + other.power)
    contrast *= math.exp(-((apart / radius) ** 2) / 2)
    if not math.isfinite(length):
        return Meeting(delay, contrast, length)
    # of beams that cross at an angle the paths differ from one edge of the spot to the other: in the mean over a
    # Gaussian spot that makes the range of delays wider, and fringes less clear by as much
    wide = math.hypot(length, float(np.linalg.norm(one.beam.along - other.beam.along)) * radius / math.sqrt(2))
    return Meeting(delay, contrast * length / wide, wide)


def _path(arrival: Arrival, at: NDArray[np.float64]) -> float:
    """Return the optical path of a beam's wavefront at a place [mm]."""
    beam = arrival.beam
    return beam.path + beam.index * float((at - beam.at) @ beam.along)
