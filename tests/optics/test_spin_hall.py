"""The spin Hall shift at a tilted polarizer, traced on a bench, against the table of its theory."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from light_benches import kind, light

from pico.model.pose import Pose
from pico.optics.light import Light

TABLE = Path(__file__).parents[1] / "data" / "shel_shift.csv"
LENSES = {"e1": (125.0, 150.0), "e2": (100.0, 150.0), "e3": (100.0, 200.0)}
RADIUS, AWAY = 0.65, 1.0


def bench(
    first: float, second: float, tilt: float, *, substrate: str = "film", extinction: float | None = None,
    angle: float = AWAY, radius: float = RADIUS, film: float = 90.0,
) -> Light:  # fmt: skip
    """The case study with exactly what its table assumes: a collimated beam at the first lens, thin lenses, the tilted
    polarizer in the front focal plane of the second, the camera in its back focal plane. `angle`: of the first
    polarizer from crossed."""
    lens = 400.0
    kinds = {
        "laser": kind("hene_laser", waist_radius=radius, waist_position=lens - 160.0, polarization=film - 90.0),
        "p1": kind("linear_polarizer", extinction=extinction), "lx": kind("plano_convex_100", focal_length=first),
        "p2": kind("linear_polarizer", extinction=extinction, substrate=substrate, refractive_index=1.5),
        "ly": kind("plano_convex_100", focal_length=second), "cam": kind("beam_camera"),
    }  # fmt: skip
    # the same optics behind the first lens: its focus is in p2
    p2 = lens + first
    poses = {
        "laser": Pose(100, 420), "p1": Pose(300, 420), "lx": Pose(lens, 420), "p2": Pose(p2, 420, tilt),
        "ly": Pose(p2 + second, 420), "cam": Pose(p2 + 2 * second, 420),
    }  # fmt: skip
    return light(kinds, poses, {"p1": {"angle": film - 90.0 + angle}, "p2": {"angle": film}})


def shift(found: Light) -> float:
    """The shift across the tilt [um]."""
    (arrival,) = found.at("cam")
    return 1000 * arrival.center[1]


def rows() -> list[dict[str, float]]:
    lines = [line for line in TABLE.read_text().splitlines() if not line.startswith("#")]
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


@pytest.mark.parametrize(("substrate", "column"), [("film", "ideal"), ("ar_glass", "ar")])
@pytest.mark.parametrize("lenses", LENSES)
def test_the_shift_is_that_of_the_table(lenses: str, substrate: str, column: str) -> None:
    for row in rows():
        wanted = row[f"{lenses}_{column}_um"]
        found = abs(shift(bench(*LENSES[lenses], row["tilt_deg"], substrate=substrate)))
        assert found == pytest.approx(wanted, rel=1e-3, abs=0.02), row["tilt_deg"]


def closed_form(first: float, second: float, tilt: float, away: float, leak: float) -> float:
    """|y| at the camera [um] by the closed form of the theory; both polarizers let a share `leak` of what they block
    through, in phase, so that the first one's field is turned a little back towards the laser's."""
    wavelength, theta, delta = 632.8e-6, math.radians(tilt), math.radians(away)
    c, weak = math.tan(theta), math.sqrt(leak)
    alpha = math.cos(delta) ** 2 + weak * math.sin(delta) ** 2
    beta = (1 - weak) * math.sin(delta) * math.cos(delta)
    square = ((RADIUS / first) ** 2 + (wavelength / (math.pi * RADIUS)) ** 2) / 4
    g, power = math.exp(-2 * c**2 * square), alpha**2 + beta**2
    passed = (power + (beta**2 - alpha**2) * g) / 2
    # what leaks through the second is the rest, and is moved the other way
    moment = 2 * c * square * g * alpha * beta * (1 - leak)
    return 1000 * second * moment / (passed + leak * (power - passed))


@pytest.mark.parametrize("extinction", [1e5, 1e4])
@pytest.mark.parametrize("lenses", LENSES)
def test_leaking_polarizers_weaken_it_as_their_theory_says(lenses: str, extinction: float) -> None:
    for tilt in (10.0, 30.0, 45.0):
        found = abs(shift(bench(*LENSES[lenses], tilt, extinction=extinction)))
        assert found == pytest.approx(closed_form(*LENSES[lenses], tilt, AWAY, 1 / extinction), rel=1e-4)


def test_it_is_zero_without_tilt_and_odd_in_tilt_and_in_the_polarizers_angle() -> None:
    e1 = LENSES["e1"]
    assert shift(bench(*e1, 0.0)) == 0.0
    plain = shift(bench(*e1, 30.0))
    assert abs(plain) > 60
    assert shift(bench(*e1, -30.0)) == pytest.approx(-plain, rel=1e-9)
    assert shift(bench(*e1, 30.0, angle=-AWAY)) == pytest.approx(-plain, rel=1e-9)
    assert shift(bench(*e1, 30.0, film=0.0)) == pytest.approx(0.0, abs=1e-6), "the film absorbs across the tilt"
    (arrival,) = bench(*e1, 30.0).at("cam")
    assert arrival.center[0] == pytest.approx(0.0, abs=1e-9)


def test_circular_light_is_shifted_by_the_wavelength_alone() -> None:
    """By lambda / 2 pi tan(tilt) behind the plate, one way or the other: at 45 deg 100.7 nm."""
    for angle, sign in ((45.0, 1), (-45.0, -1)):
        kinds = {
            "laser": kind("hene_laser", waist_radius=0.5, waist_position=200.0), "q": kind("quarter_wave_plate"),
            "p2": kind("linear_polarizer"), "cam": kind("beam_camera"),
        }  # fmt: skip
        poses = {"laser": Pose(100, 420), "q": Pose(250, 420), "p2": Pose(360, 420, 45), "cam": Pose(450, 420)}
        (arrival,) = light(kinds, poses, {"q": {"angle": angle}, "p2": {"angle": 90.0}}).at("cam")
        assert 1e6 * arrival.center[1] == pytest.approx(sign * 632.8 / (2 * math.pi), rel=2e-3)


def test_what_a_picture_shows_is_what_the_closed_form_says() -> None:
    (arrival,) = bench(*LENSES["e1"], 30.0).at("cam")
    y, z = np.linspace(-4, 4, 801), np.linspace(-4, 4, 801)
    picture = arrival.irradiance(y, z)
    area = (y[1] - y[0]) * (z[1] - z[0])
    assert picture.sum() * area == pytest.approx(arrival.power, rel=1e-6)
    assert (picture.sum(axis=1) * z).sum() / picture.sum() == pytest.approx(arrival.center[1], rel=1e-6)


@pytest.mark.parametrize("lenses", LENSES)
def test_frames_of_the_camera_show_it_to_a_fifth_of_a_micrometer(lenses: str) -> None:
    from pico.kernels.frame import Frame
    from pico.kernels.pipeline import parsed, run
    from pico.optics.beam_table import exposed
    from pico.optics.instruments import camera_frame, sensor_of

    row = next(r for r in rows() if r["tilt_deg"] == 30)
    found = bench(*LENSES[lenses], 30.0)
    part = found.parts["cam"]
    strength = exposed(found, part)
    assert strength is not None
    part = replace(part, values={"exposure": 0.6 / strength.times})  # of 1 ms, where none is set
    sensor = sensor_of(part)
    counts = camera_frame(found.at("cam"), part, seed=3)
    frame = Frame(
        counts, pixel_size=sensor.pitch, full_scale=sensor.full_scale, black_level=sensor.black,
        read_noise=sensor.read_noise, electrons_per_count=sensor.electrons_per_count(0.0),
    )  # fmt: skip
    centroid = run(parsed("image | centroid"), frame)
    assert abs(centroid.value["y"]) == pytest.approx(row[f"{lenses}_ideal_um"], abs=0.2), centroid
