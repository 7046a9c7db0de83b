"""Direction and zero of an axis follow from readings of its scale, with an error bar that holds."""

from __future__ import annotations

import numpy as np
import pytest

from pico.diagnostics import PicoError
from pico.model.calibration.axis_zero import zero_of

AT = (10.0, 61.0, 104.0, 158.0, 209.0, 256.0, 324.0)


def read(direction: int, zero: float, seed: int, period: float = 360.0, noise: float = 0.2) -> list[float]:
    random = np.random.default_rng(seed)
    seen = [direction * at + zero + random.normal(0, noise) for at in AT]
    return [float(np.floor(value / 0.5 + 0.5) * 0.5 % period) for value in seen]


@pytest.mark.parametrize(("direction", "zero", "period"), [(1, 12.5, 180.0), (-1, 0.0, 180.0), (-1, -170.0, 360.0)])
def test_direction_and_zero_are_found_and_the_error_bar_holds(direction: int, zero: float, period: float) -> None:
    found = [zero_of("p1.angle", AT, read(direction, zero, seed, period), period, 0.5) for seed in range(1000)]
    off = np.array([np.remainder(f.axis.zero - zero + period / 2, period) - period / 2 for f in found])
    sigmas = np.array([f.axis.sigma for f in found])
    assert {f.axis.direction for f in found} == {direction}
    assert np.all(np.abs(off) < 4 * sigmas) and np.mean(np.abs(off) < 2 * sigmas) >= 0.9
    assert np.median(sigmas) < 1.5 * off.std()
    assert all(f.held_out >= f.residual - 1e-9 for f in found)


def test_readings_that_tell_no_direction_or_follow_nothing_are_refused() -> None:
    with pytest.raises(PicoError, match="do not tell in which direction it turns"):
        zero_of("p1.angle", (0.0, 90.0, 180.0, 270.0), (5.0, 95.0, 185.0, 275.0), 180.0, 0.5)
    with pytest.raises(PicoError, match="has 3 readings; 4 is the least"):
        zero_of("p1.angle", AT[:3], (1.0, 2.0, 3.0), 180.0, 0.5)
    with pytest.raises(PicoError, match="do not"):
        zero_of("p1.angle", AT, (0.0, 90.0, 20.0, 300.0, 150.0, 10.0, 77.0), 180.0, 0.5)
