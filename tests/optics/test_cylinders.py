"""Two cylinder lenses at 30 deg to each other, against a wave that is carried plane wave by plane wave."""

from __future__ import annotations

import math

import numpy as np
import pytest
from light_benches import kind, light
from numpy.typing import NDArray

from pico.model.pose import Pose

WAVELENGTH = 632.8e-6  # mm
NUMBER, WIDTH = 1024, 9.0  # grid; mm
LINE = (np.arange(NUMBER) - NUMBER // 2) * WIDTH / NUMBER
Y, Z = np.meshgrid(LINE, LINE)
Wavefield = NDArray[np.complex128]


def carried(field: Wavefield, distance: float) -> Wavefield:
    """Return a field after a distance [mm], by its angular spectrum: exact, without the paraxial approximation."""
    k = 2 * math.pi / WAVELENGTH
    one = 2 * math.pi * np.fft.fftfreq(NUMBER, WIDTH / NUMBER)
    square = one[None, :] ** 2 + one[:, None] ** 2
    # sqrt(k^2 - q^2) - k, without the difference of large numbers
    lag = -square / (np.sqrt(np.maximum(k**2 - square, 0.0)) + k)
    return np.fft.ifft2(np.fft.fft2(field) * np.exp(1j * distance * lag))


def cylinder(focal: float, line: float, y: float = 0.0) -> Wavefield:
    """Return what a thin lens does that has power across a line at an angle [deg] only, and stands off by y [mm]."""
    turned = math.radians(line)
    across = Z * math.cos(turned) - (Y - y) * math.sin(turned)
    return np.exp(-1j * math.pi / WAVELENGTH * across**2 / focal)


def measured(intensity: NDArray[np.float64]) -> tuple[float, float, float, float, float]:
    """Return centroid y and z [mm], radii of the larger and smaller principal axes [mm], angle of the larger [rad]."""
    total = intensity.sum()
    y, z = (intensity * Y).sum() / total, (intensity * Z).sum() / total
    yy, zz, yz = (float((intensity * (a - b) * (c - d)).sum() / total)
                  for a, b, c, d in ((Y, y, Y, y), (Z, z, Z, z), (Y, y, Z, z)))  # fmt: skip
    half, apart = (yy + zz) / 2, math.hypot((yy - zz) / 2, yz)
    angle = math.atan2(2 * yz, yy - zz) / 2 % math.pi
    return y, z, 2 * math.sqrt(half + apart), 2 * math.sqrt(half - apart), angle


@pytest.mark.parametrize(
    ("first", "second", "lines", "aside"),
    [(220.0, 160.0, (0.0, 30.0), 0.0), (180.0, -260.0, (75.0, 105.0), 0.0), (220.0, 160.0, (-20.0, 10.0), 0.4)],
)
def test_two_cylinders_at_30_deg(first: float, second: float, lines: tuple[float, float], aside: float) -> None:
    """Radii and orientation within 1e-3, the centroid within 1e-3 of a radius, and the picture pixel by pixel."""
    waist, apart, on = 0.6, 70.0, 140.0
    kinds = {
        "laser": kind("hene_laser", waist_radius=waist, waist_position=140.0), "cam": kind("beam_camera"),
        "one": kind("plano_convex_100", focal_length=first, cylinder_axis=lines[0]),
        "two": kind("plano_convex_100", focal_length=second, cylinder_axis=lines[1]),
    }  # fmt: skip
    poses = {"laser": Pose(100, 400), "one": Pose(300, 400), "two": Pose(300 + apart, 400 + aside),
             "cam": Pose(300 + apart + on, 400)}  # fmt: skip
    (arrival,) = light(kinds, poses).at("cam")

    field = np.exp(-(Y**2 + Z**2) / waist**2) * cylinder(first, lines[0])
    field = carried(carried(field, apart) * cylinder(second, lines[1], aside), on)
    intensity = np.abs(field) ** 2 / (np.abs(field) ** 2).sum() / (WIDTH / NUMBER) ** 2
    y, z, wide, narrow, angle = measured(intensity)

    assert arrival.beam.widths[:2] == pytest.approx((wide, narrow), rel=1e-3)
    assert wide > 1.3 * narrow
    assert abs(math.sin(arrival.beam.widths[2] - angle)) < 1e-3
    assert arrival.center == pytest.approx((y, z), abs=1e-3 * narrow)
    assert np.abs(arrival.irradiance(LINE, LINE) - intensity).max() < 2e-3 * intensity.max()
