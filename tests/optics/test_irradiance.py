"""Pictures of beams are sums of their waves' fields: a direct sum says the same, on turned and distant detectors."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from light_benches import kind, light

from pico.model.pose import Pose
from pico.optics.beam import Beam
from pico.optics.irradiance import Screen, irradiance

Y, Z = np.linspace(-3, 3, 61), np.linspace(2.5, -2.5, 51)


def summed(beams: list[Beam], screen: Screen) -> np.ndarray:
    """Return |sum of fields|^2, point by point, each field as `pico.optics.beam` has it."""
    out = np.zeros((len(Z), len(Y)))
    keys = {(b.source, w.group) for b in beams for w in b.waves}
    for (n, z), (m, y) in product(enumerate(Z), enumerate(Y)):
        for key in keys:
            field = np.zeros(3, dtype=complex)
            for beam in beams:
                k, here = beam.wave_number, screen.origin + y * screen.left + z * screen.up - beam.at
                r, ahead = beam.frame @ here, here @ beam.along
                phase = 2 * math.pi * (beam.path / beam.wavelength % 1 + beam.index * ahead / beam.wavelength)
                size = math.sqrt(k * math.sqrt(np.linalg.det(beam.curvature.imag)) / math.pi)
                size *= math.sqrt(abs(beam.along @ screen.along))
                for wave in beam.waves:
                    if (beam.source, wave.group) == key:
                        shape = np.exp(1j * k * (r @ beam.curvature @ r / 2 + wave.shift @ r) + 1j * phase)
                        field = field + size * shape * wave.field
            out[n, m] += float(np.sum(np.abs(field) ** 2))
    return out


def screen(yaw: float, left: float = 0.0) -> Screen:
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    return Screen(np.array([900.0, 420.0 + left, 70.0]), np.array([c, s, 0.0]), np.array([-s, c, 0.0]), np.eye(3)[2])


def crossed(second: float = 90.5) -> list[Beam]:
    """Two beams of one laser that meet at a small angle, each of several waves behind a tilted polarizer."""
    kinds = {
        "laser": kind("hene_laser", waist_radius=0.4), "p1": kind("linear_polarizer"),
        "p2": kind("linear_polarizer"), "lens": kind("plano_convex_100", focal_length=400.0),
        "cam": kind("beam_camera"),
    }  # fmt: skip
    poses = {"laser": Pose(100, 420), "p1": Pose(250, 420), "p2": Pose(360, 420, 30), "lens": Pose(500, 420),
             "cam": Pose(900, 420)}  # fmt: skip
    found = []
    for y, angle in ((420.0, 90.0), (420.4, second)):
        given = {"p1": {"angle": 1.5}, "p2": {"angle": angle}}
        (arrival,) = light(kinds, poses | {"lens": Pose(500, y)}, given).at("cam")
        found.append(arrival.beam)
    return found


@pytest.mark.parametrize(("yaw", "left"), [(0.0, 0.0), (25.0, 0.0), (0.0, 1.5), (-40.0, -0.7)])
def test_it_is_the_square_of_the_sum_of_all_fields(yaw: float, left: float) -> None:
    beams, on = crossed(), screen(yaw, left)
    found, wanted = irradiance(beams, on, Y, Z), summed(beams, on)
    assert np.abs(found - wanted).max() < 1e-9 * wanted.max()
    coarse = irradiance(beams, on, Y, Z, np.float32)
    assert coarse.dtype == np.float32 and np.abs(coarse - wanted).max() < 1e-4 * wanted.max()


@pytest.mark.parametrize("bend", [1e-7, 1e-5, 2e-4, 1e-3])
def test_a_picture_in_single_precision_is_as_good_where_a_beam_is_bent_a_little_across(bend: float) -> None:
    """As lenses that lean bend it: what is told by few products, by more, and pixel by pixel."""
    beams = [replace(b, curvature=b.curvature + bend * (1 + 0.3j) * np.array([[0, 1], [1, 0]])) for b in crossed()]
    wanted = summed(beams, screen(0.0))
    assert np.abs(irradiance(beams, screen(0.0), Y, Z, np.float32) - wanted).max() < 5e-5 * wanted.max()


def test_beams_that_are_skew_have_pictures_that_are() -> None:
    kinds = {
        "laser": kind("hene_laser", waist_radius=0.6, waist_position=300.0),
        "one": kind("plano_convex_100", focal_length=300.0, cylinder_axis=0.0),
        "two": kind("plano_convex_100", focal_length=250.0, cylinder_axis=30.0), "cam": kind("beam_camera"),
    }  # fmt: skip
    poses = {"laser": Pose(100, 420), "one": Pose(400, 420), "two": Pose(450, 420), "cam": Pose(900, 420)}
    (arrival,) = light(kinds, poses).at("cam")
    for yaw in (0.0, 30.0):
        wanted = summed([arrival.beam], screen(yaw))
        assert np.abs(irradiance([arrival.beam], screen(yaw), Y, Z) - wanted).max() < 1e-9 * wanted.max()


@pytest.mark.parametrize("left", [-8.0, 40.0, 500.0])
def test_what_falls_beside_the_detector_leaves_it_dark_and_finite(left: float) -> None:
    for kind_of in (np.float32, np.float64):
        found = irradiance(crossed(), screen(0.0, left), Y, Z, kind_of)
        assert np.isfinite(found).all() and (found >= 0).all()
        assert found.max() == 0 if abs(left) > 20 else found.max() < 1e-6
