"""A camera's sensor: from the light that falls on it to the counts that it gives, with all that is wrong with it.

Electrons are counted without units, positions are pixels, row 0 at the top. A frame is made band by band, so that a
sensor of five million pixels takes no more memory than its picture. The same seed and number give the same frame.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count

import numpy as np
from numpy.typing import NDArray

from pico.model.simulated import SensorErrors
from pico.optics.sensing.noise import Electrons, shot, unlit

Counts = NDArray[np.uint16]
Exposed = Callable[[int, int], Electrons]
"""Gives the mean photo-electrons (last - first, width) of the rows from first to last."""

BAND = 64
"""Rows that are made at once."""
BLACK = 64.0
"""Where a type does not say it, the counts of a frame without light."""


@dataclass(frozen=True, slots=True)
class Sensor:
    """What a sensor is. `size`: pixels across and up; `pitch`: of its pixels [um]; `full_well` [electrons] is what it
    tells as `full_scale` counts at a gain of 0 dB; `read_noise`: one standard deviation [electrons]; `dark_current`
    [electrons/s]; `black`: counts of a frame without light; `name`: patterns of its own hang on it."""

    size: tuple[int, int]
    pitch: float
    bits: int = 12
    full_well: float = 10500.0
    read_noise: float = 2.5
    dark_current: float = 0.0
    black: float = BLACK
    name: str = ""

    @property
    def full_scale(self) -> int:
        return int(2**self.bits) - 1

    @property
    def y(self) -> NDArray[np.float64]:
        """Where its columns are [mm], to the left of who looks along the light: to the right in its picture."""
        return np.asarray((np.arange(self.size[0]) - (self.size[0] - 1) / 2) * self.pitch * 1e-3, dtype=np.float64)

    @property
    def z(self) -> NDArray[np.float64]:
        """Where its rows are [mm], up; row 0 is at the top."""
        return np.asarray(((self.size[1] - 1) / 2 - np.arange(self.size[1])) * self.pitch * 1e-3, dtype=np.float64)

    def electrons_per_count(self, gain: float) -> float:
        """Return the electrons of one count at a gain [dB]."""
        return self.full_well / (self.full_scale - self.black) / 10 ** (gain / 20)


def frame(
    sensor: Sensor, exposed: Exposed, *, exposure: float, gain: float = 0.0, errors: SensorErrors | None = None,
    seed: int = 1, number: int = 0,
) -> Counts:  # fmt: skip
    """Return the frame (up, across) that a sensor gives.

    `exposed`: the mean photo-electrons of its rows; `exposure` [ms]; `gain` [dB]; `seed` of the noise, and the `number`
    of the frame: shot noise, read noise and flicker are others in each, the sensor's own patterns are not.
    """
    across, up = sensor.size
    wrong = errors or SensorErrors()
    out = np.empty((up, across), dtype=np.uint16)
    draws = np.random.SeedSequence([seed, number, zlib.crc32(sensor.name.encode())])
    flicker = 1.0 + wrong.flicker * np.random.default_rng(draws.spawn(1)[0]).standard_normal()
    dark = sensor.dark_current * exposure * 1e-3

    def band(first: int, child: np.random.SeedSequence) -> None:
        last = min(first + BAND, up)
        mean = exposed(first, last) * np.float32(max(flicker, 0.0))
        if wrong.fringes or wrong.non_uniformity:
            mean *= response(sensor, wrong, first, last)
        if dark or wrong.hot_pixels:
            mean += dark_electrons(sensor, wrong, exposure, first, last)
        _read(sensor, mean, gain, np.random.Generator(np.random.SFC64(child)), out[first:last])

    starts = range(0, up, BAND)
    with ThreadPoolExecutor(min(4, cpu_count() or 1)) as pool:
        list(pool.map(band, starts, draws.spawn(len(starts))))
    return out


def _read(sensor: Sensor, mean: Electrons, gain: float, draw: np.random.Generator, out: Counts) -> None:
    """Write the counts of mean electrons into `out`."""
    per = sensor.electrons_per_count(gain)
    counts = unlit(sensor.read_noise / per, sensor.black, sensor.full_scale).draw(0, mean.size, draw)
    electrons = shot(mean.ravel(), draw)
    lit = np.flatnonzero(electrons > 0)
    electrons = electrons[lit]
    electrons += np.float32(sensor.read_noise) * draw.standard_normal(len(lit), dtype=np.float32)
    np.minimum(electrons, np.float32(sensor.full_well * 1.2), out=electrons)  # a pixel overflows
    electrons *= np.float32(1 / per)
    electrons += np.float32(sensor.black + 0.5)
    counts[lit] = np.clip(electrons, 0, sensor.full_scale, out=electrons)  # cut off: the half above rounds
    out[...] = counts.reshape(mean.shape)


def response(sensor: Sensor, errors: SensorErrors, first: int, last: int) -> Electrons:
    """Return the response (last - first, across) of the pixels of some rows, 1 on average: a pattern of this sensor."""
    across, _ = sensor.size
    own = zlib.crc32(sensor.name.encode())
    found = np.ones((last - first, across), dtype=np.float32)
    if errors.non_uniformity:
        draw = np.random.Generator(np.random.SFC64([own, first]))
        found += np.float32(errors.non_uniformity) * draw.standard_normal(found.shape, dtype=np.float32)
    if errors.fringes:
        angle, phase = np.random.default_rng(own).uniform(0, 2 * np.pi, 2)
        turn = np.float32(2 * np.pi / (_FRINGE / sensor.pitch))
        rows = turn * np.float32(np.sin(angle)) * np.arange(first, last, dtype=np.float32)
        columns = turn * np.float32(np.cos(angle)) * np.arange(across, dtype=np.float32) + np.float32(phase)
        # cos(a + b), so that no cosine is taken for each pixel
        wave = np.cos(rows)[:, None] * np.cos(columns) - np.sin(rows)[:, None] * np.sin(columns)
        found += np.float32(errors.fringes) * wave
    return np.maximum(found, np.float32(0), out=found)  # a pixel is deaf at worst: it gives no light back


_FRINGE = 400.0
"""How far fringes of a cover glass are apart [um]: a wedge of about 2 arc minutes at a visible wavelength."""
_HOT = 20000.0
"""What a hot pixel fills by itself [electrons/s]."""


def dark_electrons(sensor: Sensor, errors: SensorErrors, exposure: float, first: int, last: int) -> Electrons:
    """Return the mean electrons (last - first, across) of an exposure [ms] without light."""
    across, up = sensor.size
    found = np.full((last - first, across), sensor.dark_current * exposure * 1e-3, dtype=np.float32)
    if errors.hot_pixels:
        draw = np.random.default_rng([zlib.crc32(sensor.name.encode()), 1])
        count = max(1, round(errors.hot_pixels * across * up))
        rows, columns = draw.integers(0, up, count), draw.integers(0, across, count)
        here = (rows >= first) & (rows < last)
        found[rows[here] - first, columns[here]] += np.float32(_HOT * exposure * 1e-3)
    return found
