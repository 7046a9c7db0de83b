"""Benches on which nothing is wrong, for `wrong_benches.py`: usual setups as textbooks and pages of vendors describe
them, each at a wavelength that suits its parts, and the shipped labs at all of their states."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import yaml
from wrong_benches_drawn import HENE, Bench, laser, line, part, read

from pico.resources import labs_dir

METER = ("pm", "power_meter", {"wavelength": HENE})
CAMERA = ("cam", "beam_camera", {"exposure": 0.1})
FAINT = {"POWER": "0.0005 mW"}
"""What a camera takes without being full."""
DIODE = ("pd", "photodiode", {"gain": "20 dB"})


def shipped() -> Iterator[Bench]:
    """Yield each state of each shipped lab."""
    for path in sorted(labs_dir().glob("*/history.yaml")):
        for commit in yaml.safe_load(path.read_text())["commits"]:
            yield Bench(f"{path.parent.name} at {commit['tag']}", example=(path.parent.name, commit["tag"]))


def _interferometers(rng: Random) -> Iterator[Bench]:
    y = rng.uniform(350, 450)
    mirror = {"tip": 0, "tilt": 0, "piezo": 2}
    michelson = {
        "laser": laser(150, y), "bs": part("beam_splitter_50_50", 450, y),
        "m1": part("piezo_mirror", 650, y, 0, **mirror), "m2": part("piezo_mirror", 450, y + 200, 90, **mirror),
        "pd": part("photodiode", 450, y - 200, -90, gain="20 dB"),
    }  # fmt: skip
    yield Bench("Michelson interferometer at 633 nm", michelson, {}, read("pd", "photodiode"))
    green = {**michelson, "laser": laser(150, y, 532)}
    yield Bench("Michelson interferometer at 532 nm", green, {}, read("pd", "photodiode"))
    y = rng.uniform(280, 380)
    mach_zehnder = {
        "laser": laser(150, y), "bs1": part("beam_splitter_50_50", 400, y),
        "m1": part("mirror_tip_tilt", 700, y, -45, tip=0, tilt=0),
        "m2": part("piezo_mirror", 400, y + 200, 135, **mirror),
        "bs2": part("beam_splitter_50_50", 700, y + 200, 0),
        "pd": part("photodiode", 860, y + 200, 0, gain="20 dB"),
        "other": part("photodiode", 700, y + 360, 90, gain="20 dB"),
    }  # fmt: skip
    yield Bench("Mach-Zehnder interferometer at 633 nm", mach_zehnder, {}, read("pd", "photodiode"))


def _polarization(rng: Random) -> Iterator[Bench]:
    p1, p2 = ("p1", "linear_polarizer", {"angle": 0}), ("p2", "linear_polarizer", {"angle": 70})
    q, h = ("q", "quarter_wave_plate", {"angle": 45}), ("h", "half_wave_plate", {"angle": 15})
    cube = ("pbs", "polarizing_beam_splitter", {})
    yield Bench("polarizer, quarter-wave plate, analyzer", line(rng, HENE, p1, q, p2, METER), {},
                (*read("pm", "power_meter"), "optimize null q pm --dry-run"))  # fmt: skip
    yield Bench("crossed polarizers by a search", line(rng, HENE, p1, p2, DIODE), {},
                (*read("pd", "photodiode"), "optimize null p2 pd --dry-run"))  # fmt: skip
    yield Bench("power by a half-wave plate and a cube", line(rng, HENE, h, cube, METER), {},
                (*read("pm", "power_meter"), "optimize peak h pm --dry-run"))  # fmt: skip
    goal = {"dark": {"tunables": {"p2.angle": [40, 140]}, "minimize": "pd.voltage"}}
    yield Bench("a goal of one's own over an analyzer", line(rng, HENE, p1, p2, DIODE), goal,
                (*read("pd", "photodiode"), "optimize dark --dry-run"))  # fmt: skip
    yield Bench("an isolator, a plate, a polarizer", line(rng, HENE, ("iso", "faraday_isolator", {}), h, p1, METER), {},
                (*read("pm", "power_meter"), "optimize peak h pm --dry-run"))  # fmt: skip
    glan = ("g", "glan_polarizer", {"angle": 0})
    yield Bench("calcite polarizer at 780 nm", line(rng, 780, glan, ("pm", "power_meter", {"wavelength": 780})), {},
                read("pm", "power_meter"))  # fmt: skip


def _lenses(rng: Random) -> Iterator[Bench]:
    y = rng.uniform(300, 500)
    kepler = {
        "laser": laser(120, y, **FAINT), "l1": part("plano_convex_60", 300, y),
        "l2": part("plano_convex_150", 510, y, 180),
        "cam": part("beam_camera", 800, y, exposure=0.1),
    }  # fmt: skip
    yield Bench("Keplerian telescope", kepler, {}, read("cam", "beam_camera"))
    galileo = {
        "laser": laser(120, y, **FAINT), "l1": part("plano_concave", 300, y, 180),
        "l2": part("plano_convex_200", 400, y, 180),
        "cam": part("beam_camera", 800, y, exposure=0.1),
    }  # fmt: skip
    yield Bench("Galilean telescope", galileo, {}, read("cam", "beam_camera"))
    fourier = {
        "laser": laser(120, y, **FAINT), "l1": part("achromat", 400, y), "stop": part("iris", 500, y, opening=3),
        "l2": part("achromat", 600, y, 180), "cam": part("beam_camera", 700, y, exposure=0.1),
    }  # fmt: skip
    yield Bench("4f system with an iris in its Fourier plane", fourier, {}, read("cam", "beam_camera"))
    expander = ("x", "beam_expander", {})
    yield Bench(
        "beam expander at 532 nm", line(rng, 532, expander, CAMERA, source=FAINT), {}, read("cam", "beam_camera")
    )
    cleaner = ("sf", "spatial_filter", {"pinhole_y": 0, "pinhole_z": 0})
    yield Bench("spatial filter", line(rng, HENE, cleaner, CAMERA, source=FAINT), {},
                (*read("cam", "beam_camera"), "optimize spatial_filter sf --dry-run"))  # fmt: skip
    stage = ("lens", "lens_xyz_stage", {"stage_x": 0, "stage_y": 0.2, "stage_z": 0})
    yield Bench("lens centered on a camera", line(rng, HENE, stage, CAMERA, source=FAINT), {},
                (*read("cam", "beam_camera"), "optimize centre lens cam --dry-run"))  # fmt: skip


def _fibers(rng: Random) -> Iterator[Bench]:
    y = rng.uniform(300, 400)
    flat = {"tip": 0, "tilt": 0}
    walk = {
        "laser": laser(200, y, HENE), "m1": part("mirror_tip_tilt", 500, y, -45, **flat),
        "m2": part("mirror_tip_tilt", 500, y + 250, 135, **flat), "fc": part("fiber_coupler", 800, y + 250),
    }  # fmt: skip
    yield Bench("two mirrors into a fiber at 633 nm", walk, {},
                (*read("fc", "fiber_coupler"), "optimize fibre fc --dry-run"))  # fmt: skip
    infrared = {
        "laser": laser(200, y, 1064), "m1": part("mirror_tip_tilt", 500, y, -45, **flat),
        "pd": part("photodiode", 500, y + 250, 90, gain="20 dB"),
    }  # fmt: skip
    yield Bench("silver mirror and silicon diode at 1064 nm", infrared, {}, read("pd", "photodiode"))


def _others(rng: Random) -> Iterator[Bench]:
    yield Bench("bandpass before a diode", line(rng, HENE, ("f", "bandpass_filter", {}), DIODE), {},
                read("pd", "photodiode"))  # fmt: skip
    yield Bench("shutter open before a meter", line(rng, HENE, ("gate", "shutter", {"shutter": "open"}), METER), {},
                read("pm", "power_meter"))  # fmt: skip
    wheel = ("w", "filter_wheel", {"position": "at_2"})
    yield Bench("filter wheel at 532 nm", line(rng, 532, wheel, ("pm", "power_meter", {"wavelength": 532})), {},
                read("pm", "power_meter"))  # fmt: skip
    yield Bench("density filter before a meter", line(rng, HENE, ("nd", "neutral_density_filter", {}), METER), {},
                read("pm", "power_meter"))  # fmt: skip
    yield Bench("spectrometer of a helium-neon laser", line(rng, HENE, ("s", "spectrometer", {"exposure": 10})), {},
                read("s", "spectrometer"))  # fmt: skip
    red = line(rng, HENE, ("d", "dichroic_mirror", {"yaw": 45}), DIODE)
    yield Bench("red light through a dichroic mirror", red, {}, read("pd", "photodiode"))
    y = rng.uniform(300, 400)
    dichroic = {
        "laser": laser(150, y, 473), "d": part("dichroic_mirror", 450, y, -45),
        "pm": part("power_meter", 450, y + 200, 90, wavelength=473),
    }  # fmt: skip
    yield Bench("blue light off a dichroic mirror", dichroic, {}, read("pm", "power_meter"))
    asphere = ("a", "asphere", {})
    yield Bench("aspheric lens at 850 nm", line(rng, 850, asphere, DIODE), {}, read("pd", "photodiode"))


def right(seed: int) -> list[Bench]:
    """Return all of them: setups that vary by the seed, then the shipped labs."""
    rng = Random(seed)
    made = [b for make in (_interferometers, _polarization, _lenses, _fibers, _others) for b in make(rng)]
    return [*made, *shipped()]
