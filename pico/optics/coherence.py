"""How far two beams of one source are in step, by its spectrum and the difference of their optical paths.

Frequencies are in waves of 1 mm, dnu / c [1/mm], so that they go with paths in mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from pico.model.catalog import ComponentType

DISPERSION = 0.1
"""By which share of what glass adds to a path, (n - 1) d, the delay of a pulse is longer than the index says: 0.04 to
0.1 for crown and flint in the visible, as their index changes with the wavelength."""
_SHORTEST, _LONGEST = 1e-5, 1e7
"""Between which lengths a source may be coherent [mm]."""
_IN_STEP = 0.05
"""The share of its coherence length by which glass may shift a wave train before nobody can tell what is seen."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a spectrum: `detuning` from the carrier and full `width` at half maximum [1/mm], `share` of the
    power."""

    detuning: float
    width: float
    shape: Literal["gaussian", "lorentzian"]
    share: float

    def envelope(self, delta: Any) -> Any:
        """Return the visibility that the width leaves at a difference of paths [mm]: the transform of the line's shape,
        exp(-(pi w d)^2 / (4 ln 2)) of a Gaussian, exp(-pi w |d|) of a Lorentzian. Goodman, Statistical Optics, 5.1."""
        reach = math.pi * self.width * np.abs(delta)
        return np.exp(-reach if self.shape == "lorentzian" else -(reach**2) / (4 * math.log(2)))

    def slope(self, delta: float) -> complex:
        """Return how the exponent of its term in `degree` changes with the difference of paths [1/mm]."""
        reach = math.pi * self.width
        fall = reach * np.sign(delta) if self.shape == "lorentzian" else reach**2 * delta / (2 * math.log(2))
        return complex(-fall, 2 * math.pi * self.detuning)

    def bends(self, delta: float, span: float) -> float:
        """Return what is left out where, over a `span` of differences of paths around one [mm], the exponent is taken
        to change by `slope` alone."""
        reach = math.pi * self.width * span
        if self.shape == "lorentzian":
            return 2 * reach if abs(delta) < span else 0.0
        return reach**2 / (4 * math.log(2))


Spectrum = tuple[Line, ...]
"""The lines of one polarization; none: a single frequency. Their shares add up to 1."""


def degree(spectrum: Spectrum, delta: Any) -> NDArray[np.complex128]:
    """Return the complex degree of coherence of two beams, of which the first is longer by `delta` [mm], any shape:
    the sum over lines of share exp(i 2 pi detuning delta) envelope(delta), next to the phase of the carrier."""
    delta = np.asarray(delta, dtype=float)
    found = np.zeros(delta.shape, dtype=complex) if spectrum else np.ones(delta.shape, dtype=complex)
    for line in spectrum:
        found += line.share * np.exp(2j * math.pi * line.detuning * delta) * line.envelope(delta)
    return found


def bandwidth(spectrum: Spectrum) -> float:
    """Return how wide a spectrum is [1/mm]: from the first line's lower to the last line's upper half maximum."""
    edges = [line.detuning + side * line.width / 2 for line in spectrum for side in (-1, 1)]
    return max(edges, default=0.0) - min(edges, default=0.0)


def spectra_of(kind: ComponentType, wavelength: float) -> tuple[tuple[float | None, float, Spectrum], ...]:
    """Return the lines of a source's type by their polarization: the angle [deg], None for the type's own; the share of
    the power; the spectrum. `wavelength` of the carrier [nm]."""
    given = kind.optics.lines or ()
    whole = sum(line.share for line in given)
    found = []
    for angle in dict.fromkeys(line.polarization for line in given):
        mine = [line for line in given if line.polarization == angle]
        power = sum(line.share for line in mine)
        lines = (
            Line(m.detuning(wavelength), m.width_of(wavelength), m.shape, m.share / power) for m in mine if m.share
        )
        if power:
            found.append((angle, power / whole, tuple(lines)))
    return tuple(found) or ((None, 1.0, ()),)


def coherence_length(spectra: Iterable[tuple[float | None, float, Spectrum]]) -> float:
    """Return the difference of paths [mm], to a twentieth of itself, at which the visibility of fringes has fallen to
    1/e for the first time; infinite where it never does. `spectra` as of `spectra_of`."""
    deltas = np.geomspace(_SHORTEST, _LONGEST, 1 + round(math.log(_LONGEST / _SHORTEST) / 0.05))
    seen = np.abs(sum(share * degree(spectrum, deltas) for _, share, spectrum in spectra))
    first = np.flatnonzero(seen <= math.exp(-1))
    return float(deltas[first[0]]) if len(first) else math.inf


def dispersed(glass: Iterable[float], spectra: Iterable[Spectrum]) -> bool:
    """Return whether beams of one source cannot be told to be in step, as dispersion in glass is not modelled: `glass`:
    by how much it makes the path of each longer, (n - 1) d [mm]."""
    added = tuple(glass)
    shift = DISPERSION * (max(added, default=0.0) - min(added, default=0.0))
    return shift * max((bandwidth(s) for s in spectra), default=0.0) > _IN_STEP
