"""Power meters and photodiodes read what falls on them, as exactly as their types say."""

from __future__ import annotations

import numpy as np
import pytest
from light_benches import kind, light

from pico.model.pose import Pose
from pico.optics.instruments import power_reading


def reading(detector: str, seed: int = 1, number: int = 0, **values: object) -> tuple[float, float, bool]:
    kinds = {"laser": kind("hene_laser", power=1.3), "pd": kind(detector)}
    found = light(kinds, {"laser": Pose(100, 420), "pd": Pose(500, 420)}, {"pd": values})
    one = power_reading(found.at("pd"), found.parts["pd"], seed=seed, number=number)
    return one.value, one.sigma, one.saturated


def test_a_power_meter_is_wrong_by_a_share_that_stays() -> None:
    read = np.array([reading("power_meter", seed)[:2] for seed in range(200)])
    assert read[:, 0].mean() == pytest.approx(1.3, rel=0.005)
    assert read[:, 0].std() == pytest.approx(read[0, 1], rel=0.2) and read[0, 1] == pytest.approx(0.015 * 1.3, rel=0.01)
    same = [reading("power_meter", 3, n)[0] for n in range(20)]
    assert np.std(same) < 1e-3 * np.mean(same)


def test_a_photodiode_gives_volts_by_its_gain_until_its_amplifier_ends() -> None:
    assert reading("photodiode", gain="0 dB")[0] == pytest.approx(1.3e-3 * 0.4 * 1510, abs=1e-3)
    assert reading("photodiode", gain="20 dB")[0] == pytest.approx(1.3e-3 * 0.4 * 15100, abs=1e-3)
    assert reading("photodiode", gain="40 dB") == (10.0, pytest.approx(1e-4), True)
