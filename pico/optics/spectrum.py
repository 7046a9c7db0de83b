"""What a spectrometer sees: the power of each beam over wavelength, as blurred as the instrument has it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from pico.optics.beam import moments
from pico.optics.light import Arrival
from pico.optics.part import Part

_SIGMA = 2 * math.sqrt(2 * math.log(2))
"""Full width at half maximum over the standard deviation of a Gaussian."""
FULL = 65535.0
"""Counts of a channel of 16 bits."""


def channels(part: Part) -> NDArray[np.float64]:
    """Return the wavelengths of the channels (n,) [nm]: `channels` of them from `shortest` to `longest`."""
    count = round(part.number("channels", "", 2048))
    return np.linspace(part.number("shortest", "nm", 350.0), part.number("longest", "nm", 1050.0), count)


def density(arrivals: Iterable[Arrival], part: Part) -> NDArray[np.float64]:
    """Return the power (n,) [mW] in each channel: every line, of its own shape and width, blurred by a Gaussian of the
    instrument's `resolution`, its full width at half maximum. Wide against a channel or not: a line is integrated over
    it, so that what is narrow is not lost between two."""
    at = channels(part)
    step = float(at[1] - at[0])
    edges = np.append(at - step / 2, at[-1] + step / 2)
    blur = part.number("resolution", "nm", 1.0) / _SIGMA
    total = np.zeros(len(at))
    for arrival in arrivals:
        for center, width, shape, power in _lines(arrival):
            total += power * np.diff(_below(edges, center, width, shape, blur))
    return total


def _lines(arrival: Arrival) -> Iterator[tuple[float, float, str, float]]:
    """Yield the lines of a beam: center and full width at half maximum [nm], shape, and power [mW]."""
    beam = arrival.beam
    whole = sum(float((np.abs(w.field) ** 2).sum()) for w in beam.waves)
    for group in sorted({w.group for w in beam.waves}):
        mine = sum(float((np.abs(w.field) ** 2).sum()) for w in beam.waves if w.group == group) / whole
        power = moments(beam)[0] * (1.0 - arrival.clipped) * mine
        lines = beam.spectra[group] if beam.spectra else ()
        for line in lines:
            center = 1e6 / (1 / beam.wavelength + line.detuning)
            yield center, 1e-6 * center**2 * line.width, line.shape, power * line.share
        if not lines:
            yield beam.wavelength * 1e6, 0.0, "gaussian", power


def _below(edges: NDArray[np.float64], center: float, width: float, shape: str, blur: float) -> NDArray[np.float64]:
    """Return which share of a line lies below wavelengths (n,) [nm]: of a Gaussian in closed form, of a Lorentzian
    blurred by one the sum of Lorentzians at the nodes of Gauss and Hermite."""
    if shape == "lorentzian" and width > 0:
        nodes, weights = np.polynomial.hermite.hermgauss(64)
        away = edges[:, None] - center - math.sqrt(2) * blur * nodes
        return np.asarray((0.5 + np.arctan(2 * away / width) / math.pi) @ weights / math.sqrt(math.pi))
    sigma = math.hypot(width / _SIGMA, blur)
    return np.array([0.5 * (1 + math.erf(x)) for x in ((edges - center) / (math.sqrt(2) * sigma)).tolist()])


def recorded(
    arrivals: Iterable[Arrival], part: Part, *, seed: int = 1, number: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the counts of the channels (n,) above their dark level, and the standard deviation of each: shot noise of
    `electrons_per_count`, and `read_noise` [electrons]. A channel reads 65,535 at most."""
    exposure, per_nanojoule = part.value("exposure", "ms", 10.0), part.number("sensitivity", "count/nJ", 1.0)
    mean = density(arrivals, part) * exposure * 1e3 * per_nanojoule  # mW ms = 1000 nJ
    gain, read = part.number("electrons_per_count", "", 1.0), part.number("read_noise", "", 0.0)
    sigma = np.sqrt(mean * gain + read**2) / gain
    noise = np.random.default_rng([seed, number, *part.name.encode()]).standard_normal(len(mean))
    return np.minimum(np.round(mean + sigma * noise), FULL), sigma


def middle(counts: NDArray[np.float64], sigma: NDArray[np.float64], part: Part) -> tuple[float, float, float, float]:
    """Return the mean wavelength [nm] and the width [nm], twice sqrt(2 ln 2) of the standard deviation, of what stands
    out of the noise, each with its standard deviation; NaN where nothing does."""
    at, floor = channels(part), 5 * float(sigma.min())
    bright = counts > floor
    if not bright.any():
        return math.nan, math.nan, math.nan, math.nan
    reach = np.flatnonzero(bright)
    window = slice(max(0, reach[0] - 3), reach[-1] + 4)
    c, s, w = counts[window], sigma[window], at[window]
    whole = float(c.sum())
    mean = float(c @ w) / whole
    square = max(float(c @ (w - mean) ** 2) / whole, 1e-12)
    of_mean = float(np.sqrt((((w - mean) * s) ** 2).sum())) / whole
    of_square = float(np.sqrt(((((w - mean) ** 2 - square) * s) ** 2).sum())) / whole
    return mean, _SIGMA * math.sqrt(square), of_mean, _SIGMA * of_square / (2 * math.sqrt(square))
