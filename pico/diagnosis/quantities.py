"""What is read to tell how a bench is: quantities, each of one measurement or of a scan of a few.

The same laws make a quantity of what was measured and of what a ray model expects, so that both can be compared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from pico.model.quantities import Value

FLICKER = 0.002
"""By which share light changes from one reading to the next, one standard deviation."""
DARK = 2.0
"""Standard deviations below which a reading of a share tells no more than that there is no light."""
Law = Literal["as it is", "share", "null", "depth", "peak"]


@dataclass(frozen=True)
class Shot:
    """One measurement of `address` (`cam.power`), with tunables `at` others than they stand at, by address."""

    address: str
    at: Mapping[str, Value] = field(default_factory=dict)

    @property
    def key(self) -> str:
        """What tells it from others."""
        return " ".join([self.address, *(f"{name}={self.at[name]!r}" for name in sorted(self.at))])


@dataclass(frozen=True)
class Quantity:
    """What is made of shots by a law; its coordinate is what causes change in proportion.

    `as it is`: the `number` of the only shot, in its unit. `share`: its natural logarithm. `null`: where over the
    `tunable` the reading is least, by the law of Malus, c0 - A cos(n (a - null)) with n = `harmonic`, in the unit of
    the tunable; `depth`: the logarithm of the reading there. `peak`: where it is greatest, by a parabola through its
    logarithm.
    """

    name: str
    shots: tuple[Shot, ...]
    number: str = ""
    law: Law = "as it is"
    unit: str = ""
    tunable: str = ""
    harmonic: int = 2


@dataclass(frozen=True)
class Got:
    """A quantity in its coordinate, with one standard deviation."""

    value: float
    sigma: float


def quantity(wanted: Quantity, readings: Sequence[tuple[float, float]]) -> Got | None:
    """Return a quantity of the readings of its shots, each with its standard deviation; None where they do not tell."""
    if len(readings) != len(wanted.shots) or not all(math.isfinite(v) for pair in readings for v in pair):
        return None
    if wanted.law == "as it is":
        return Got(*readings[0])
    if wanted.law == "share":
        value, sigma = readings[0]
        least = max(value, DARK * sigma)  # in the dark it is no more than that
        return Got(math.log(least), math.hypot(FLICKER, sigma / least)) if least > 0 else None
    at = np.array([float(shot.at[wanted.tunable]) for shot in wanted.shots])
    values, sigmas = (np.array(each) for each in zip(*readings, strict=True))
    if wanted.law == "peak":
        return _peak(at, values, sigmas)
    return _malus(wanted, at, values, sigmas)


def _malus(wanted: Quantity, at: Any, values: Any, sigmas: Any) -> Got | None:
    middle, turn = float(at.mean()), math.radians(wanted.harmonic)
    noise = np.hypot(sigmas, FLICKER * np.abs(values)) + 1e-12 * float(np.abs(values).max())
    angle = turn * (at - middle)
    design = np.stack([np.ones_like(at), np.cos(angle), np.sin(angle)], axis=1)
    found, spread = _fitted(design, values, noise)
    if found is None:
        return None
    c0, c1, c2 = found
    swing = math.hypot(c1, c2)
    if swing < 5 * math.sqrt(spread[1, 1] + spread[2, 2]) and wanted.law == "null":
        return None
    if wanted.law == "null":
        to = np.array([0.0, -c2, c1]) / swing**2
        return Got(middle + math.atan2(-c2, -c1) / turn, math.sqrt(float(to @ spread @ to)) / turn)
    to = np.array([1.0, -c1 / swing, -c2 / swing])
    sigma, least = math.sqrt(float(to @ spread @ to)), c0 - swing
    least = max(least, sigma, 1e-12 * abs(c0))
    return Got(math.log(least), min(1.0, math.hypot(FLICKER, sigma / least)))


def _peak(at: Any, values: Any, sigmas: Any) -> Got | None:
    if float(values.min()) <= 0:
        return None
    middle, size = float(at.mean()), float(np.ptp(at)) / 2
    x = (at - middle) / size
    found, spread = _fitted(np.stack([np.ones_like(x), x, x**2], axis=1), np.log(values),
                            np.hypot(FLICKER, sigmas / values))  # fmt: skip
    if found is None or found[2] > -3 * math.sqrt(spread[2, 2]):
        return None  # it does not bend down
    to = np.array([0.0, -0.5 / found[2], 0.5 * found[1] / found[2] ** 2])
    return Got(middle - 0.5 * size * found[1] / found[2], size * math.sqrt(float(to @ spread @ to)))


def _fitted(design: Any, values: Any, noise: Any) -> tuple[Any, Any]:
    """Return the coefficients of a weighted linear fit, and their covariance; None where the points are too few."""
    weighted = design / noise[:, None]
    normal = weighted.T @ weighted
    try:
        spread = np.linalg.inv(normal)
    except np.linalg.LinAlgError:
        return None, None
    return spread @ (weighted.T @ (values / noise)), spread
