"""Direction and zero of an axis that turns, from values that a person reads off its scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.diagnostics import PicoError, error
from pico.model.calibration.results import AxisZero

USUAL, COUNTS = 0.5, 4
"""How far a reading of a scale is usually off, as a share of what it is read to, and as how many readings that counts:
few readings may agree by chance."""
LEAST = 4
"""Readings that tell direction and zero, with what is left of them."""
CLEAR = 4.0
"""The other direction must leave so many times as much, for the direction to be certain."""


@dataclass(frozen=True)
class FoundZero:
    """An axis as its scale was read."""

    axis: AxisZero
    residual: float
    """What is left of the readings, root mean square, in their unit."""
    held_out: float
    """The same, each reading against the zero that the others give."""


def zero_of(address: str, nominal: Sequence[float], read: Sequence[float], period: float, step: float) -> FoundZero:
    """Return direction and zero of the axis `address`.

    `nominal`: the values by the lab's `map` alone; `read`: what the scale showed there; `period`: after how much both
    are the same again; `step`: to how much the scale was read. Raises PicoError if the readings are too few, do not
    tell the direction, or fit neither.
    """
    if len(read) < LEAST:
        text = f"{address} has {len(read)} readings; {LEAST} is the least"
        raise PicoError(error("calibration-axis", text, hint="read the scale at more positions", address=address))
    (left, direction), (other, _) = sorted((_fit(nominal, read, period, d)[1], d) for d in (1, -1))
    floor = max(left, step / math.sqrt(12))
    if other < CLEAR * floor:
        text = f"the readings of {address} do not tell in which direction it turns: {left:.3g} or {other:.3g} are left"
        hint = "read the scale again, at positions that are not symmetric"
        raise PicoError(error("calibration-axis", text, hint=hint, address=address))
    if left > period / 20:
        text = f"the readings of {address} do not follow its position: {left:.3g} are left of them"
        raise PicoError(error("calibration-axis", text, hint="see that the mount turns freely", address=address))
    count, sign = len(read), 1 if direction > 0 else -1
    zero = _fit(nominal, read, period, sign)[0]
    apart = [
        _wrap(read[i] - sign * nominal[i] - _fit(*_without(nominal, read, i), period, sign)[0], period)
        for i in range(count)
    ]
    squares = left**2 * count + COUNTS * (USUAL * step) ** 2
    single = max(math.sqrt(squares / (count - 1 + COUNTS - 2)), step / math.sqrt(12))  # the mean of the variance
    found = AxisZero(direction=1 if sign > 0 else -1, zero=zero, sigma=single / math.sqrt(count))
    return FoundZero(found, left, math.sqrt(sum(v * v for v in apart) / count))


def _without(nominal: Sequence[float], read: Sequence[float], i: int) -> tuple[list[float], list[float]]:
    return [v for j, v in enumerate(nominal) if j != i], [v for j, v in enumerate(read) if j != i]


def _fit(nominal: Sequence[float], read: Sequence[float], period: float, direction: int) -> tuple[float, float]:
    """The zero for one direction, and what is left, root mean square."""
    off = [value - direction * at for at, value in zip(nominal, read, strict=True)]
    x, y = (sum(f(2 * math.pi * v / period) for v in off) for f in (math.cos, math.sin))
    about = math.atan2(y, x) / (2 * math.pi) * period
    left = [_wrap(v - about, period) for v in off]
    mean = sum(left) / len(left)
    return _wrap(about + mean, period), math.sqrt(sum((v - mean) ** 2 for v in left) / len(left))


def _wrap(value: float, period: float) -> float:
    return math.remainder(value, period)
