"""What instruments make of the light that arrives: a camera a frame, a power meter and a photodiode a reading."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations, groupby

import numpy as np

from pico.model.materials.glass import DESIGN
from pico.model.materials.response import ratio
from pico.model.simulated import SensorErrors
from pico.optics.beam_table import decibel, efficiency, electrons
from pico.optics.light import Arrival, irradiance
from pico.optics.part import Part, side
from pico.optics.sensing.noise import Electrons
from pico.optics.sensing.sensor import Counts, Sensor, frame

_GRID = 401
ROOM = 550.0
"""Wavelength at which light of the room counts [nm]."""


def sensor_of(part: Part) -> Sensor:
    """Return the sensor of a camera, by its type."""
    return Sensor(
        size=(round(part.number("pixels_across", "pixel", 0)), round(part.number("pixels_up", "pixel", 0))),
        pitch=part.number("pixel_size", "um", 1.0), bits=round(part.number("bit_depth", "bit", 12)),
        full_well=part.number("full_well", "", 1e4), read_noise=part.number("read_noise", "", 0.0),
        dark_current=part.number("dark_current", "", 0.0) + part.unseen.dark,
        black=part.number("black_level", "count", 0.0), name=part.name,
    )  # fmt: skip


def electrons_of(arrivals: Iterable[Arrival], part: Part, stray: float = 0.0) -> Electrons:
    """Return the mean photo-electrons (up, across) of a camera in one exposure; `stray`: light of the room on its
    sensor [nW/mm2]."""
    sensor, exposure = sensor_of(part), part.value("exposure", "ms", 1.0)
    per_power = (sensor.pitch * 1e-3) ** 2 * exposure
    room = stray * 1e-6 * per_power * electrons(ROOM, efficiency(part, ROOM))
    total: Electrons | None = None
    for wavelength, found in groupby(sorted(arrivals, key=lambda a: a.wavelength), key=lambda a: a.wavelength):
        light = irradiance(tuple(found), sensor.y, sensor.z, np.float32)
        light *= np.float32(per_power * electrons(wavelength, efficiency(part, wavelength)))
        total = light if total is None else total + light  # of most cameras there is one: pictures are large
    if total is None:
        return np.full((sensor.size[1], sensor.size[0]), room, dtype=np.float32)
    if room:
        total += np.float32(room)
    return total


def camera_frame(
    arrivals: Iterable[Arrival], part: Part, *, stray: float = 0.0, errors: SensorErrors | None = None, seed: int = 1,
    number: int = 0,
) -> Counts:  # fmt: skip
    """Return the frame (up, across) of a camera, row 0 at the top; see `pico.optics.sensing.sensor.frame`."""
    mean = electrons_of(arrivals, part, stray)
    return frame(
        sensor_of(part), lambda first, last: mean[first:last], exposure=part.value("exposure", "ms", 1.0),
        gain=decibel(part.values) + 20 * math.log10(part.unseen.gain), errors=errors, seed=seed, number=number,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Power:
    """A reading [mW or V], its standard deviation, and whether it was more than the instrument can tell. `noise`: the
    part of the standard deviation that differs from reading to reading; None: all of it."""

    value: float
    sigma: float
    saturated: bool = False
    noise: float | None = None


def power_on(arrivals: tuple[Arrival, ...], part: Part, aside: float = 0.0) -> float:
    """Return the power [mW] that beams bring to a detector, `aside` of whose origin its area is, to the left [mm]:
    those of one source interfere on it.

    What interference adds or takes is summed over its area, fringe by fringe as far as the grid shows them; finer ones
    add nothing.
    """
    power = float(sum(a.power for a in arrivals))
    if power <= 0 or len({a.beam.source for a in arrivals}) == len(arrivals):
        return power
    line = np.linspace(-1, 1, _GRID) * part.number("active_diameter", "mm", 2 * part.optic.radius) / 2
    inside = line[None, :] ** 2 + line[:, None] ** 2 <= line[-1] ** 2
    step, alone = float(line[1] - line[0]), [irradiance((a,), line + aside, line) for a in arrivals]
    more = sum(
        float(((irradiance((a, b), line + aside, line) - alone[n] - alone[m]) * inside).sum()) * step**2
        for (n, a), (m, b) in combinations(enumerate(arrivals), 2)
        if a.beam.source == b.beam.source and _period(a, b) > 2 * step
    )
    return max(0.0, power + more)


def balanced_reading(arrivals: tuple[Arrival, ...], part: Part, *, seed: int = 1, number: int = 0) -> Power:
    """Return what a balanced detector gives [V]: the left diode's power less the right one's, by its responsivity and
    amplifier; of what both have in common it passes a rest, less by `rejection` [dB] of the power."""
    apart = part.number("separation", "mm", 0.0) / 2
    powers = [
        power_on(tuple(a for a in arrivals if side(part, a.beam.at) == which), part, which * apart)
        for which in (1.0, -1.0)
    ]
    common = min(powers) * 10 ** (-part.number("rejection", "dB", 120.0) / 10)
    per_power = 1e-3 * part.number("responsivity", "A/W", 1.0) * part.number("transimpedance", "V/A", 1.0)
    dark, most = part.number("noise", "V", 1e-4), part.number("saturation", "V", math.inf)
    noise = np.random.default_rng([seed, number, *part.name.encode()]).standard_normal()
    signal = (powers[0] - powers[1] + common) * per_power * part.unseen.gain + part.unseen.dark + dark * noise
    return Power(max(-most, min(signal, most)), dark, abs(signal) >= most)


def _period(one: Arrival, other: Arrival) -> float:
    """Return how far fringes of two beams are apart on a detector [mm]."""
    _, left, up = one.part.axes
    turned = other.beam.along - one.beam.along
    size = math.hypot(float(turned @ left), float(turned @ up))
    return one.beam.wavelength / size if size else math.inf


def relative(part: Part, wavelength: float) -> float:
    """Return what a detector tells of light of a wavelength [nm] as a share of what is there: of the wavelength that
    it is set to, or whose `responsivity` its type gives, 1."""
    sensor = part.word("sensor", "")
    if "wavelength" in part.kind.tunables:
        return ratio(sensor, wavelength, part.value("wavelength", "nm", wavelength))
    return ratio(sensor, wavelength, part.number("design_wavelength", "nm", DESIGN)) if sensor else 1.0


def power_reading(arrivals: Iterable[Arrival], part: Part, *, seed: int = 1, number: int = 0) -> Power:
    """Return what a power meter reads [mW], or a photodiode behind its amplifier [V].

    A meter is wrong by a share, the same for all its readings, of which `uncertainty` is two standard deviations; and
    each reading has the noise `least_power`. It takes light to be of the `wavelength` that it is set to, and a reading
    of another is wrong by the ratio of what its material gives of the two. The `responsivity` of a photodiode holds at
    its `design_wavelength`.
    """
    power = 0.0
    for wavelength, found in groupby(sorted(arrivals, key=lambda a: a.wavelength), key=lambda a: a.wavelength):
        power += power_on(tuple(found), part) * relative(part, wavelength)
    own = np.random.default_rng([seed, *part.name.encode()]).standard_normal()
    noise = np.random.default_rng([seed, number, *part.name.encode()]).standard_normal()
    volts = part.kind.number("saturation", "V")
    if volts is not None:
        gain = part.number("transimpedance", "V/A", 1.0) * 10 ** (decibel(part.values) / 20)
        dark = part.number("noise", "V", 1e-4)
        gain *= part.unseen.gain
        signal = power * 1e-3 * part.number("responsivity", "A/W", 1.0) * gain + part.unseen.dark + dark * noise
        return Power(min(signal, volts), dark, signal >= volts)
    least, greatest = part.number("least_power", "mW", 0.0), part.number("greatest_power", "mW", math.inf)
    share = part.number("uncertainty", "", 0.0) / 2
    read = power * (1 + share * own) * part.unseen.gain + part.unseen.dark + least * noise
    return Power(min(read, greatest), math.hypot(share * power, least), read >= greatest, least)
