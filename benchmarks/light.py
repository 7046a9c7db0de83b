"""How fast light is: rays through nine surfaces, and the light of a whole bench.

    python benchmarks/light.py [--repeat 50] [--lab labs/shel]

The nine are those of the golden case of two mirrors, two real lenses, a tilted plate and a camera
(tests/data/optiland_rays.json). Printed are medians of wall time.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.optics_references import RAYS, surfaces_of  # noqa: E402

from pico.bench.picturing.contents import standing, wanted  # noqa: E402
from pico.drawing.beams import standing as upright  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.optics.light import Light, light_of  # noqa: E402
from pico.optics.rays import rays, trace  # noqa: E402

CASE = "two mirrors, two lenses, a plate and a camera"


def median_ms(work: Callable[[], object], repeat: int) -> float:
    """Return the median wall time [ms] of some work, after it was done once."""
    work()
    times = []
    for _ in range(repeat):
        begun = time.perf_counter()
        work()
        times.append(1000 * (time.perf_counter() - begun))
    return statistics.median(times)


def rays_through(count: int, repeat: int) -> tuple[int, float]:
    """Return the number of surfaces, and how long as many rays take through them [ms]."""
    case = next(c for c in json.loads(RAYS.read_text())["cases"] if c["name"] == CASE)
    surfaces = surfaces_of(case)
    aside = np.linspace(-1.5, 1.5, count)
    begun = rays(np.stack([aside, 0.5 * aside**2, 0 * aside], axis=1), np.tile([0.0, 0.0, 1.0], (count, 1)))
    assert trace(surfaces, begun)[-1].alive.all(), "rays that miss are no measure"
    return len(surfaces), median_ms(lambda: trace(surfaces, begun), repeat)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=50)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    given = parser.parse_args()
    for count in (1, 10, 100, 10000):
        surfaces, took = rays_through(count, given.repeat)
        print(f"{count:6} rays through {surfaces} surfaces: {took:8.3f} ms")
    setup, state = load_folder(given.lab).require()[:2]
    poses, values = upright(standing(setup, state)), wanted(state)

    def shone() -> Light:
        return light_of(setup, poses, values, lit=lambda _: True)

    found = shone()
    print(f"the light of {given.lab.name}, {len(poses)} components on the table, {len(found.crossings)} crossings, "
          f"{max((len(c.beam.waves) for c in found.crossings), default=0)} waves at most: "
          f"{median_ms(shone, given.repeat):.2f} ms")  # fmt: skip


if __name__ == "__main__":
    main()
