"""A Mach-Zehnder interferometer of ideal parts, and the same by scalar fields: a pencil of light from below comes to
`bs1`; one arm goes over a delay stage, the other over m2 and m3."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from light_benches import kind, light
from oracles import two_beams
from oracles.two_beams import Arm, folded

from pico.model.catalog import ComponentType, SpectralLine
from pico.model.pose import Pose
from pico.optics.instruments import power_on
from pico.optics.light import Arrival, Light, irradiance

WAVELENGTH, WAIST = 632.8e-6, 1.3
EQUAL = 5.0
"""Where the stage stands for arms of the same length [mm]."""
MODE = 299792.458 / 500
"""Waves of a difference of 500 MHz are as long [mm]."""
POSES = {
    "laser": Pose(320, 100, 90), "bs1": Pose(320, 320), "delay": Pose(785, 345), "m2": Pose(320, 510, 135),
    "m3": Pose(470, 510, 45), "bs2": Pose(470, 370, 180), "cam": Pose(220, 370, 180), "meter": Pose(470, 230, -90),
}  # fmt: skip


def source(*lines: SpectralLine, **parameters: Any) -> ComponentType:
    found = kind("hene_laser", **{"waist_radius": WAIST, "polarization": 90.0} | parameters)
    return replace(found, optics=replace(found.optics, lines=lines or None))


def bench(laser: ComponentType, values: Mapping[str, Any], **more: tuple[ComponentType, Pose]) -> Light:
    """Return the light of the interferometer; `values`: such as `delay_stage_x`, by component and tunable."""
    splitter, mirror = kind("beam_splitter_50_50"), kind("piezo_mirror", reflectance=1.0)
    camera = kind("beam_camera", pixels_across=500, pixels_up=320, pixel_size=10.0, filter_density=2.0)
    kinds = {
        "laser": laser, "bs1": splitter, "delay": kind("delay_stage", reflectance=1.0), "m2": mirror, "m3": mirror,
        "bs2": splitter, "cam": camera, "meter": kind("power_meter"),
    }  # fmt: skip
    kinds |= {name: one for name, (one, _) in more.items()}
    given: dict[str, dict[str, Any]] = {"delay": {"stage_x": EQUAL}}
    for key, value in values.items():
        name, _, tunable = key.partition("_")
        given.setdefault(name, {})[tunable] = value
    return light(kinds, POSES | {name: pose for name, (_, pose) in more.items()}, given)


def arms(stage: float = EQUAL, tip: float = 0.0, port: str = "cam") -> tuple[Arm, Arm]:
    """Return both arms, as mirrors fold them: over the delay, whose roof are two, and over m2 and m3."""
    cube1, cube2 = (320 + 320j, math.pi / 4), (470 + 370j, math.pi / 4)
    edge = complex(785 - 155 + stage, 345)
    roof = [(edge, math.pi / 4), (edge, 3 * math.pi / 4)]
    m2, m3 = (320 + 510j, math.pi / 4), (470 + 510j, 3 * math.pi / 4 + tip)
    begun = (320 + 160j, 1j)
    if port == "cam":
        return folded(*begun, [cube1, *roof], 0.5j), folded(*begun, [m2, m3, cube2], 0.5j)
    return folded(*begun, [cube1, *roof, cube2], -0.5), folded(*begun, [m2, m3], 0.5)


def read(found: Light, port: str = "meter") -> float:
    return power_on(found.at(port), found.parts[port])


def expected(delta: float, degree: Callable[[float], float]) -> float:
    """Return what scalar fields bring to the meter, where the arm over the delay is longer by `delta`: it is reflected
    twice, the other one not at all."""
    overlap = two_beams.overlap(WAIST, WAVELENGTH, delta) * cmath.exp(2j * math.pi * delta / WAVELENGTH)
    return 0.5 * (1 - degree(delta) * overlap.real)


def seen(arrivals: tuple[Arrival, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    y, z = np.linspace(-2.5, 2.5, 201), np.linspace(2, -2, 81)
    return irradiance(arrivals, y, z), y, z


def wanted(y: np.ndarray, z: np.ndarray, both: tuple[Arm, Arm], spectrum: Any = ((0.0, 1.0),)) -> np.ndarray:
    """Return what scalar fields make on the camera: it looks along -x, so its left is -y of the table."""
    place = 220 + 1j * (370 - y)[None, :]
    return two_beams.screen(both, place, z[:, None], WAIST, WAVELENGTH, spectrum, looks=-1 + 0j)
