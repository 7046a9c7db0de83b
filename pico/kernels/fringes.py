"""The carrier of fringes on a picture. Needs numpy at its top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.kernels.moments import sums

Array = NDArray[np.float64]
_REFINED = 4
"""Parabolas through three frequencies each, every one four times as close as the last."""


@dataclass(frozen=True)
class Fringes:
    """`frequency` to the right and up [1/px] and its spread along and across itself [1/px]; `amplitude` of the windowed
    light there, 0 where no carrier stands out, and `light`, that at no frequency [count]; `noise`, one standard
    deviation of the amplitude [count]."""

    frequency: tuple[float, float]
    spread: tuple[float, float]
    amplitude: float
    light: float
    noise: float


def fringes(signal: Array, variance: Array, fewest: float) -> Fringes | None:
    """Return the strongest carrier of light (h, w) [count] with a variance of each pixel; None without light. `fewest`:
    fringes across the windowed light (four standard deviations) below which they are its own shape."""
    window = np.hanning(signal.shape[0] + 2)[1:-1, None] * np.hanning(signal.shape[1] + 2)[None, 1:-1]
    seen = signal * window
    middle = ((signal.shape[0] - 1) / 2, (signal.shape[1] - 1) / 2)
    moments = sums(seen, middle)
    light = float(moments[0, 0])
    if light <= 0:
        return None
    across, down = (max(float(moments[j]) / light - (float(moments[i]) / light) ** 2, 1.0)
                    for i, j in (((0, 1), (0, 2)), ((1, 0), (2, 0))))  # fmt: skip
    at = _strongest(seen, fewest / 4, across, down)
    noise = sums(window**2 * variance, middle) / 2
    if at is None:
        return Fringes((0.0, 0.0), (math.inf, math.inf), 0.0, light, math.sqrt(noise[0, 0]))
    at, amplitude = _refined(seen, at)
    return Fringes(at, _spread(at, moments, noise, amplitude), amplitude, light, math.sqrt(noise[0, 0]))


def _strongest(seen: Array, fewest: float, across: float, down: float) -> tuple[float, float] | None:
    """The frequency, to the right and up, of the strongest line that is none of the beam's own shape: one that stands
    out to all sides, as the skirt of two spots side by side does not. None where there is none."""
    h, w = seen.shape
    whole = np.abs(np.fft.rfft2(seen))
    right, up = np.fft.rfftfreq(w)[None], -np.fft.fftfreq(h)[:, None]
    power = np.where(right**2 * across + up**2 * down < fewest**2, 0.0, whole)
    row, column = np.unravel_index(int(power.argmax()), power.shape)
    out = _stands_out(whole)
    if not out[row, column]:
        power = np.where(out, power, 0.0)
        row, column = np.unravel_index(int(power.argmax()), power.shape)
    if not power[row, column]:
        return None
    return float(right[0, column]), float(up[row, 0])


def _stands_out(power: Array) -> NDArray[np.bool_]:
    """Where a frequency has more power than those next to it; up and down they come round."""
    found = np.ones(power.shape, dtype=bool)
    for down in (-1, 0, 1):
        moved = np.roll(power, down, axis=0)
        found[:, 1:] &= power[:, 1:] >= moved[:, :-1]
        found[:, :-1] &= power[:, :-1] >= moved[:, 1:]
        found &= power >= moved
    return found


def _at(seen: Array, right: float, up: float) -> float:
    h, w = seen.shape
    along = np.exp(-2j * np.pi * right * (np.arange(w) - (w - 1) / 2))
    return float(abs(np.exp(2j * np.pi * up * (np.arange(h) - (h - 1) / 2)) @ (seen @ along)))


def _refined(seen: Array, at: tuple[float, float]) -> tuple[tuple[float, float], float]:
    """The frequency of the greatest amplitude near one, and that."""
    place = list(at)
    for step in (0.5 / 4**i for i in range(_REFINED)):
        for axis, size in ((0, seen.shape[1]), (1, seen.shape[0])):
            moves = [place[axis] + shift * step / size for shift in (-1, 0, 1)]
            low, mid, high = (_at(seen, *((m, place[1]) if axis == 0 else (place[0], m))) for m in moves)
            bend = low - 2 * mid + high
            shift = 0.0 if bend >= 0 else max(-1.0, min(1.0, (low - high) / (2 * bend)))
            place[axis] += shift * step / size
    return (place[0], place[1]), _at(seen, place[0], place[1])


def _spread(at: tuple[float, float], light: Array, noise: Array, amplitude: float) -> tuple[float, float]:
    """How far noise moves the greatest amplitude, along the frequency and across it: it turns the phase by 2 pi x."""
    length = math.hypot(*at)
    right, up = at[0] / length, at[1] / length
    out = []
    for x, y in ((right, up), (-up, right)):
        weight = np.array([[0, 0, x * x], [0, -2 * x * y, 0], [y * y, 0, 0]])
        second = float((weight * light).sum() / light[0, 0])
        out.append(math.sqrt(max(float((weight * noise).sum()), 0)) / (2 * math.pi * max(second * amplitude, 1e-12)))
    return out[0], out[1]
