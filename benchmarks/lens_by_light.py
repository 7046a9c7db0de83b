"""A lens that the arm puts down by sight, in physics, and that is then centred on the light: through its stage, or by
the arm alone.

For each seed the case study's bench is made anew, its lenses are put in their places by the arm with what physics and
cameras make of that, in a world that drifts, and `center ly_150 cam` is sought. Printed are how far the spot was from
the middle of the camera before and after, and how many measurements that took.

With `--by-arm` a lens without a stage stands one focal length before the camera of the minimal bench, and the arm puts
it down anew until the spot is in the middle, across the table; printed is how far the lens truly is from where it would
be then, by the light of the world itself.

    python benchmarks/lens_by_light.py [--by-arm] [--seeds 20]
"""

from __future__ import annotations

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

import pico
from pico.bench.bench import Bench, new_lab
from pico.places.bench import BenchPlace

NEAR = 5.0
"""How near the middle is near enough [um]."""
BY_ARM = 100.0
"""The same for the arm alone [um]."""
DIMMED = """  grey:
    type: neutral_density_filter
    pose: {x: 340, y: 420, yaw: 0}
    parameters: {optical_density: 4.5}
"""
"""What the camera needs before a beam of 2 mW that is focused on it."""
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
        found = bench.optimize("center", "ly_150", "cam")
        first, last = (
            math.hypot(of["cam.centroid.x"], of["cam.centroid.y"]) if of else math.nan
            for of in (found.first, found.last)
        )
        return first, last, found.measurements, found.met


def by_arm(folder: Path, seed: int, fidelity: str) -> tuple[float, float, int, bool]:
    """Return how far the lens was off before and after [um], how often it was put down, and whether that was met."""
    new_lab(folder, "minimal")
    lab = folder / "lab.yaml"
    sim = f"sim: {{seed: {seed}, sight: pixels}}\n"
    lab.write_text(lab.read_text().replace("inventory:\n", f"{sim}inventory:\n{DIMMED}", 1))
    with pico.open(folder, fidelity=fidelity) as bench:
        report = bench.apply()
        if report.outcome != "done":
            return math.nan, math.nan, 0, False
        first = true_off(bench)
        found = bench.placing.center("lens", "camera")
        return first, true_off(bench), len(found.tries) - 1, found.met


def true_off(bench: Bench) -> float:
    """Return how far a lens at its focal length before the camera truly is from where its spot is in the middle [um]:
    there the spot moves as far as the lens."""
    from pico.backends.sim.lighted import light_on
    from pico.backends.sim.readings import Table
    from pico.backends.sim.store import load_world

    root = bench.folder.root
    world, _ = load_world(bench.setup, BenchPlace(root, "sim"))
    found = light_on(Table(bench.setup, BenchPlace(root, "sim"), world)).at("camera")
    return 1e3 * abs(sum(a.power * a.center[0] for a in found) / sum(a.power for a in found))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--by-arm", action="store_true", help="a lens without a stage")
    parser.add_argument("--fidelity", default="physics", choices=("physics", "kinematic"))
    args = parser.parse_args()
    found = []
    with tempfile.TemporaryDirectory() as place:
        for seed in range(1, args.seeds + 1):
            found.append((by_arm if args.by_arm else run)(Path(place) / str(seed), seed, args.fidelity))
            first, last, count, met = found[-1]
            what = "times put down" if args.by_arm else "measurements"
            print(f"seed {seed:3}: {first:7.1f} um before, {last:6.2f} um after {count:2} {what}", flush=True)
            if not met:
                print("          not met")
    if args.by_arm:
        good = sum(met and last <= BY_ARM for _, last, _, met in found)
        counts = [count for _, _, count, _ in found]
        print(f"\n{good} of {len(found)} within {BY_ARM:g} um; put down {np.median(counts):g} times (median), at most "
              f"{max(counts)}; {args.fidelity}")  # fmt: skip
        return
    good = sum(met and last <= NEAR * math.sqrt(2) and count <= MOST for _, last, count, met in found)
    counts = [count for _, _, count, _ in found]
    print(f"\n{good} of {len(found)} within {NEAR:g} um each way in at most {MOST} measurements; "
          f"median {np.median(counts):g}, most {max(counts)}; {args.fidelity}")  # fmt: skip


if __name__ == "__main__":
    main()
