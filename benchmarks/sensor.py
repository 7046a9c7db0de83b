"""How long a frame of a beam camera takes in the simulator, beside the same noise by plain numpy.

    python benchmarks/sensor.py [--repeat 7] [--size 2448 2048]

Rows: the light of two interfering waves on the sensor; noise alone, without and with everything wrong with the sensor;
all together; numpy's own Poisson and normal numbers in double precision. Least times [ms].
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence

import numpy as np

from pico.model.simulated import SensorErrors
from pico.optics.beam import Beam, Wave
from pico.optics.gaussian import from_waist
from pico.optics.irradiance import Screen, irradiance
from pico.optics.sensing.sensor import Sensor, frame

WRONG = SensorErrors(non_uniformity=0.01, hot_pixels=1e-5, fringes=0.03, flicker=0.01)


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--size", type=int, nargs=2, default=(2448, 2048), metavar=("ACROSS", "UP"))
    given = parser.parse_args(words)
    across, up = given.size
    sensor = Sensor((across, up), 3.45, name="cam", dark_current=1.0, black=64.0)
    light = pictured(sensor)
    mean = (light * np.float32(8000 / light.max())).astype(np.float32)

    def made(errors: SensorErrors | None) -> Callable[[], object]:
        return lambda: frame(sensor, lambda a, b: mean[a:b], exposure=10.0, errors=errors)

    def plain() -> object:
        draw = np.random.default_rng(1)
        electrons = draw.poisson(mean.astype(float)) + 2.5 * draw.standard_normal(mean.shape)
        return np.clip(np.round(electrons / sensor.electrons_per_count(0.0) + 64), 0, 4095).astype(np.uint16)

    rows = {
        "light": lambda: pictured(sensor), "noise": made(None), "noise, everything wrong": made(WRONG),
        "light and noise, everything wrong": lambda: (pictured(sensor), made(WRONG)()), "plain numpy": plain,
    }  # fmt: skip
    print(f"{across} x {up} pixels, least of {given.repeat}:")
    for name, run in rows.items():
        print(f"  {name:34} {1000 * least(run, given.repeat):7.0f} ms")
    return 0


def pictured(sensor: Sensor) -> np.ndarray:
    """Return the light of a beam of two waves (up, across), 0.8 mm in radius."""
    along, across = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    curvature = from_waist(0.8, 632.8e-6, 50.0)
    waves = (Wave(np.array([0, 1, 1j]), np.zeros(2, dtype=complex)),
             Wave(np.array([0, -1, 1j]), np.array([0, 1e-5 + 1e-5j])))  # fmt: skip
    beam = Beam("laser", 632.8e-6, np.zeros(3), along, across, curvature, waves)
    screen = Screen(np.zeros(3), along, across, np.array([0.0, 0.0, 1.0]))
    return irradiance([beam], screen, sensor.y, sensor.z, np.float32)


def least(run: Callable[[], object], repeat: int) -> float:
    """Return the least time of some runs [s]."""
    found = []
    for _ in range(repeat):
        began = time.perf_counter()
        run()
        found.append(time.perf_counter() - began)
    return min(found)


if __name__ == "__main__":
    sys.exit(main())
