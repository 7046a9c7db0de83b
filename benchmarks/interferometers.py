"""How near an interferometer comes to scalar fields written apart, and what coherence costs.

    python benchmarks/interferometers.py [--frames 20] [--points 13] [--size 2448 2048] [--repeat 5]

The bench is a Mach-Zehnder interferometer of ideal parts with a delay stage (tests/optics/interferometer_benches.py),
the reference tests/oracles/two_beams.py. Errors are the worst over the points: of irradiance in parts of the brightest,
of powers in parts of the laser's. Frames: how far the kernel `visibility` is from the truth, in its own standard
deviations. Last come the least times [ms] of the light of one frame.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "optics")]

from interferometer_benches import (  # noqa: E402
    EQUAL,
    MODE,
    POSES,
    WAVELENGTH,
    arms,
    bench,
    expected,
    read,
    seen,
    source,
    wanted,
)
from light_benches import kind  # noqa: E402
from oracles import two_beams  # noqa: E402

from pico.kernels.frame import Frame  # noqa: E402
from pico.kernels.standard import visibility  # noqa: E402
from pico.model.catalog import ComponentType, SpectralLine  # noqa: E402
from pico.optics.instruments import camera_frame, sensor_of  # noqa: E402
from pico.optics.light import irradiance  # noqa: E402

MODES = (SpectralLine(center=-250.0), SpectralLine(center=250.0))
WIDTH = 400.0
"""Of the lines [MHz]."""
SPECTRA: dict[str, tuple[tuple[SpectralLine, ...], Callable[[float], float]]] = {
    "gaussian line, 400 MHz": (
        (SpectralLine(width=WIDTH),),
        lambda d: two_beams.visibility(two_beams.gaussian_line(WIDTH * 1e6), WIDTH * 1e6, d),
    ),
    "lorentzian line, 400 MHz": (
        (SpectralLine(width=WIDTH, shape="lorentzian"),),
        lambda d: two_beams.visibility(two_beams.lorentzian_line(WIDTH * 1e6), WIDTH * 1e6, d),
    ),
    "two modes, 500 MHz apart": (MODES, lambda d: math.cos(math.pi * d / MODE)),
}


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--points", type=int, default=13)
    parser.add_argument("--size", type=int, nargs=2, default=(2448, 2048), metavar=("ACROSS", "UP"))
    parser.add_argument("--repeat", type=int, default=5)
    given = parser.parse_args(words)
    tips = np.linspace(-2, 2, given.points)
    print(f"fringes of mirrors turned by up to 2 mrad: {max(map(fringes, tips)):.1e} of the brightest")
    white = max(map(white_light, tips))
    print(f"white light, 150 nm wide:                  {white:.1e} of the brightest")
    deltas = np.linspace(0, 600, given.points)
    for name, (lines, degree) in SPECTRA.items():
        laser = source(*lines)
        print(f"{name + ', power to 600 mm:':42} {max(power(laser, d, degree) for d in deltas):.1e}")
    modes = source(*MODES)
    print(f"both ports together, less one:             {max(abs(ports(modes, d) - 1) for d in deltas):.1e}")
    print("visibility of two modes: " + ", ".join(f"{d:.0f} mm {scanned(modes, d):.6f}" for d in (0, MODE / 2, MODE)))
    off = np.array([frame_error(d, given.frames) for d in (0.0, 150.0, 250.0, 600.0)]).ravel()
    mean, spread, worst = off.mean(), off.std(), np.abs(off).max()
    print(f"frames, {len(off)}: off by {mean:+.2f} +- {spread:.2f} standard deviations, {worst:.1f} at most")
    print(f"light of a frame of {given.size[0]} x {given.size[1]} pixels, fringes of 1 mrad:")
    for name, lines in (("one frequency", ()), ("two modes", MODES), ("white", (SpectralLine(width="150 nm"),))):
        print(f"  {name:14} {least(source(*lines), given.size, given.repeat):6.0f} ms")
    return 0


def fringes(tip: float) -> float:
    picture, y, z = seen(bench(source(), {"m3_tip": float(tip)}).at("cam"))
    fields = wanted(y, z, arms(tip=tip * 1e-3))
    return float(np.abs(picture - fields).max() / fields.max())


def white_light(tip: float) -> float:
    picture, y, z = seen(bench(source(SpectralLine(width="150 nm")), {"m3_tip": float(tip)}).at("cam"))
    sigma = 150.0 * 299792458e9 / (WAVELENGTH * 1e6) ** 2 / math.sqrt(8 * math.log(2))
    offsets = np.linspace(-6, 6, 241)
    shares = np.exp(-(offsets**2) / 2)
    spectrum = list(zip(offsets * sigma, shares / shares.sum(), strict=True))
    fields = wanted(y, z, arms(tip=tip * 1e-3), spectrum)
    return float(np.abs(picture - fields).max() / fields.max())


def power(laser: ComponentType, delta: float, degree: Callable[[float], float]) -> float:
    steps = [delta + n * WAVELENGTH / 8 for n in range(3)]
    return max(abs(read(bench(laser, {"delay_stage_x": EQUAL + d / 2})) - expected(d, degree)) for d in steps)


def ports(laser: ComponentType, delta: float) -> float:
    values = {"delay_stage_x": EQUAL + delta / 2, "m3_tip": 0.1}
    found = bench(laser, values, cam=(kind("power_meter"), POSES["cam"]))
    return read(found) + read(found, "cam")


def scanned(laser: ComponentType, delta: float) -> float:
    """Return the visibility on the meter while the stage scans a wave."""
    p = [read(bench(laser, {"delay_stage_x": EQUAL + delta / 2 + n * WAVELENGTH / 8})) for n in range(4)]
    return math.hypot(p[0] - p[2], p[1] - p[3]) / (sum(p) / 2)


def frame_error(delta: float, frames: int) -> list[float]:
    """Return how far the visibility on frames is from that of scalar fields, in standard deviations."""
    stage = EQUAL + delta / 2
    found = bench(source(*MODES, power=0.002), {"m3_tip": 1.0, "delay_stage_x": stage, "cam_exposure": 1.0})
    part, sensor = found.parts["cam"], sensor_of(found.parts["cam"])
    fields = wanted(sensor.y, sensor.z, arms(stage, 1e-3), [(-250e6, 0.5), (250e6, 0.5)])
    truth, off = two_beams.demodulated(fields, sensor.y, WAVELENGTH / 2e-3), []
    for number in range(frames):
        told = visibility.apply(
            Frame(camera_frame(found.at("cam"), part, number=number), pixel_size=sensor.pitch, exposure=1.0,
                  full_scale=sensor.full_scale, black_level=sensor.black, read_noise=sensor.read_noise,
                  electrons_per_count=sensor.electrons_per_count(0.0)),
            {},
        )  # fmt: skip
        off.append((told.value["visibility"] - truth) / told.sigma["visibility"])
    return off


def least(laser: ComponentType, size: Sequence[int], repeat: int) -> float:
    arrivals, times = bench(laser, {"m3_tip": 1.0}).at("cam"), []
    y, z = (np.linspace(-0.00345 * n / 2, 0.00345 * n / 2, n) for n in size)
    for _ in range(repeat):
        begun = time.perf_counter()
        irradiance(arrivals, y, z, np.float32)
        times.append(1000 * (time.perf_counter() - begun))
    return min(times)


if __name__ == "__main__":
    sys.exit(main())
