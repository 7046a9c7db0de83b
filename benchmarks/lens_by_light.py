"""A lens that the arm puts down by sight, in physics, and that is then centred on the light through its stage.

For each seed the case study's bench is made anew, its lenses are put in their places by the arm with what physics and
cameras make of that, in a world that drifts, and `centre ly_150 cam` is sought. Printed are how far the spot was from
the middle of the camera before and after, and how many measurements that took.

    python benchmarks/lens_by_light.py [--seeds 20]
"""

from __future__ import annotations

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

import pico
from pico.bench.bench import new_lab

NEAR = 5.0
"""How near the middle is near enough [um]."""
MOST = 12
"""Measurements that it may take."""


def run(folder: Path, seed: int, fidelity: str) -> tuple[float, float, int, bool]:
    """Return how far the spot was before and after [um], the measurements, and whether the goal was met."""
    new_lab(folder, "shel")
    lab = folder / "lab.yaml"
    lab.write_text(lab.read_text().replace("  seed: 1\n", f"  seed: {seed}\n"))
    with pico.open(folder, fidelity=fidelity) as bench:
        report = bench.apply("e1")
        if report.outcome != "done":
            return math.nan, math.nan, 0, False
        found = bench.optimize("centre", "ly_150", "cam")
        first, last = (
            math.hypot(of["cam.centroid.x"], of["cam.centroid.y"]) if of else math.nan
            for of in (found.first, found.last)
        )
        return first, last, found.measurements, found.met


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--fidelity", default="physics", choices=("physics", "kinematic"))
    args = parser.parse_args()
    found = []
    with tempfile.TemporaryDirectory() as place:
        for seed in range(1, args.seeds + 1):
            found.append(run(Path(place) / str(seed), seed, args.fidelity))
            first, last, count, met = found[-1]
            print(f"seed {seed:3}: {first:7.1f} um before, {last:6.2f} um after {count:2} measurements", flush=True)
            if not met:
                print("          not met")
    good = sum(met and last <= NEAR * math.sqrt(2) and count <= MOST for _, last, count, met in found)
    counts = [count for _, _, count, _ in found]
    print(f"\n{good} of {len(found)} within {NEAR:g} um each way in at most {MOST} measurements; "
          f"median {np.median(counts):g}, most {max(counts)}; {args.fidelity}")  # fmt: skip


if __name__ == "__main__":
    main()
