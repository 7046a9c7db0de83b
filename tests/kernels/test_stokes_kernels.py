"""Stokes parameters from readings that Jones matrices give."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.beam_pictures import field, six_states, turned_plate

from pico.kernels.frame import Readings
from pico.kernels.pipeline import parsed, run
from pico.optics.polarization import stokes

LIGHT = np.array([0.5, 0.3, 0.6]) / np.linalg.norm([0.5, 0.3, 0.6])
NAMES = ("s1", "s2", "s3")


def test_the_light_of_the_readings_is_what_the_light_model_calls_it() -> None:
    assert stokes(*field(LIGHT))[1:] == pytest.approx(LIGHT)


@pytest.mark.parametrize(("text", "bar"), [("stokes", 0.0036), ("stokes_waveplate", 0.009)])
def test_stokes_parameters_come_within_their_uncertainty(text: str, bar: float) -> None:
    made = six_states if text == "stokes" else (lambda light, seed: turned_plate(light, seed, 93.6))
    found = [run(parsed(f"readings | {text}"), made(LIGHT, seed)) for seed in range(100)]
    off = np.array([[f.value[n] - t for n, t in zip(NAMES, LIGHT, strict=True)] for f in found])
    sigma = np.array([[f.sigma[n] for n in NAMES] for f in found])
    assert np.sqrt((off**2).mean(axis=0)).max() < bar
    rms = np.sqrt(((off / sigma) ** 2).mean(axis=0))
    assert (rms > 0.8).all() and (rms < 1.25).all()


def test_the_retardance_of_a_plate_is_found() -> None:
    found = [run(parsed("readings | stokes_waveplate"), turned_plate(LIGHT, seed, 93.6)) for seed in range(30)]
    assert np.mean([f.value["retardance"] for f in found]) == pytest.approx(93.6, abs=0.3)


def test_a_plate_taken_for_another_misleads_and_one_that_is_told_does_not() -> None:
    readings = turned_plate(LIGHT, 1, 93.6)
    wrong = run(parsed("readings | stokes_waveplate(retardance=90)"), readings).value
    right = run(parsed("readings | stokes_waveplate(retardance=93.6)"), readings).value
    assert abs(wrong["s1"] - LIGHT[0]) > 0.02 > abs(right["s1"] - LIGHT[0])


@pytest.mark.parametrize(
    ("text", "readings", "said"),
    [
        ("stokes", Readings((1.0,), (0.1,), names=("across",)), "there is no reading `up`"),
        ("stokes", Readings((0.0,) * 6, (0.1,) * 6, names=six_states(LIGHT, 1).names), "there is no light"),
        ("stokes_waveplate", Readings((1.0,) * 4, (0.1,) * 4, angles=(0, 20, 40, 60)), "five angles"),
        ("stokes_waveplate", Readings((1.0,) * 8, (0.1,) * 8, angles=tuple(range(0, 160, 20))), "no retardance"),
    ],
)
def test_readings_that_say_too_little_make_no_value(text: str, readings: Readings, said: str) -> None:
    found = run(parsed(f"readings | {text}"), readings)
    assert not found.value and said in found.unknown
