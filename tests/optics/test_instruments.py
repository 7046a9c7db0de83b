"""Power meters and photodiodes read what falls on them, as exactly as their types say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from light_benches import kind, light, setup_of

from pico.model.materials.response import ratio
from pico.model.pose import Pose
from pico.optics.beam_table import troubles
from pico.optics.instruments import power_on, power_reading


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


def test_a_meter_that_is_set_for_another_wavelength_reads_wrong() -> None:
    right, wrong = (reading("power_meter", wavelength=told)[0] for told in (632.8, 1064.0))
    assert wrong / right == pytest.approx(1 / ratio("silicon", 1064.0, 632.8), rel=1e-3)


def test_a_photodiode_gives_volts_by_its_gain_until_its_amplifier_ends() -> None:
    assert reading("photodiode", gain="0 dB")[0] == pytest.approx(1.3e-3 * 0.4 * 1510, abs=1e-3)
    assert reading("photodiode", gain="20 dB")[0] == pytest.approx(1.3e-3 * 0.4 * 15100, abs=1e-3)
    assert reading("photodiode", gain="40 dB") == (10.0, pytest.approx(1e-4), True)


def test_a_meter_that_is_turned_shows_the_beam_a_narrower_opening() -> None:
    kinds = {"laser": kind("hene_laser", power=2.0), "pm": kind("power_meter")}
    (arrival,) = light(kinds, {"laser": Pose(100, 400), "pm": Pose(700, 400, 88)}).at("pm")
    slit = math.erf(math.sqrt(2) * 4.75 * math.cos(math.radians(88)) / arrival.beam.widths[0])
    assert arrival.power == pytest.approx(2 * slit, rel=3e-3)  # its ends are round, and far away


@pytest.mark.parametrize("moved", [0.0, 5e-5, 1e-4, 632.8e-6 / 4])  # of m1 along its normal [mm]
def test_the_arms_of_an_interferometer_interfere_on_meters_as_well(moved: float) -> None:
    splitter, mirror, meter = (kind(n) for n in ("beam_splitter_50_50", "mirror_tip_tilt", "power_meter"))
    kinds = {
        "laser": kind("hene_laser", power=2.0), "s1": splitter, "m1": mirror, "m2": mirror, "s2": splitter, "c": meter,
        "k": meter,
    }  # fmt: skip
    step = moved / math.sqrt(2)
    poses = {
        "laser": Pose(100, 300), "s1": Pose(400, 300), "m1": Pose(400 - step, 600 + step, 135),
        "m2": Pose(800, 300, -45), "s2": Pose(800, 600), "c": Pose(1100, 600), "k": Pose(800, 900, 90),
    }  # fmt: skip
    found = light(kinds, poses)
    read = [power_on(found.at(name), found.parts[name]) for name in ("c", "k")]
    assert sum(read) == pytest.approx(2.0, rel=1e-3)
    # the way is longer by 2 cos 45 deg of that
    phase = 2 * math.pi * math.sqrt(2) * moved / 632.8e-6
    assert read[0] == pytest.approx(2 * math.cos(phase / 2) ** 2, abs=0.01)


def test_what_falls_beside_the_sensor_does_not_saturate_it() -> None:
    kinds = {"laser": kind("hene_laser"), "cam": kind("beam_camera")}
    poses = {"laser": Pose(100, 405.3), "cam": Pose(700, 400)}
    found = troubles(setup_of(kinds), light(kinds, poses))
    assert [d.code for d in found] == ["dark"] and "5.3 mm to the left of the sensor of cam" in found[0].summary
