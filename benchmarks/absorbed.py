"""What it saves that trims make up for how parts were seen to stand, before light is asked.

Two mirrors with tip and tilt fold a beam onto a camera, 820 mm behind the first of them. For each seed the arm puts
both into their places, in kinematic fidelity with `sim: errors: {seat: S}`, in a world that drifts; then the spot is
centred by the second mirror, once from where its axes are, once after they have made up for what cameras saw of both
mirrors (x, y, yaw; what they cannot see, pitch, roll and height, light has to tell). Printed are how far the spot was
from the middle at first, dark where no light came to the sensor, and the measurements that it took to come within 5 um.

    python benchmarks/absorbed.py [--seeds 20] [--seat 1 3]
"""

from __future__ import annotations

import argparse
import math
import tempfile
from pathlib import Path

import numpy as np

import pico

LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: folded}
table: {size: [1200, 900]}
slots: {storage/a1: {x: 380, y: 260}, storage/a2: {x: 470, y: 260}}
robots:
  arm1: {model: xarm7, mount: {x: 480, y: 760, yaw: -90}}
policy: {enclosed: true}
sim: {seed: SEED, errors: {seat: SEAT}}
goals:
  centred:
    tunables: {m2.tip: [-12, 12], m2.tilt: [-12, 12]}
    reach: {cam.centroid.x: 0, cam.centroid.y: 0}
    tolerance: 5
    signal: cam.power
    least: 100
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 470}, parameters: {power: 0.02, laser_class: "1"}}
  cam:
    type: beam_camera
    pose: {x: 1060, y: 170}
    parameters: {pixels_across: 640, pixels_up: 512, pixel_size: 13, filter_density: 3}
  m1: {type: mirror_tip_tilt, marker: 1, home: storage/a1}
  m2: {type: mirror_tip_tilt, marker: 2, home: storage/a2}
"""
STATE = """apiVersion: pico/v1
kind: LabState
metadata: {lab: folded}
components:
  laser: {emission: true, shutter: open}
  cam: {exposure: 1}
  m1: {pose: {x: 540, y: 470, yaw: 45}, tip: 0, tilt: 0}
  m2: {pose: {x: 540, y: 170, yaw: -135}, tip: 0, tilt: 0}
"""


def run(folder: Path, seed: int, seat: float, absorb: bool) -> tuple[float, int, bool]:
    """Return how far the spot was at first [um], NaN where it was dark, the measurements, and whether it was met."""
    folder.mkdir(parents=True)
    (folder / "lab.yaml").write_text(LAB.replace("SEED", str(seed)).replace("SEAT", f"{seat:g}"))
    (folder / "state.yaml").write_text(STATE)
    with pico.open(folder) as bench:
        report = bench.apply()
        assert report.outcome == "done", report
        goals = bench.goals
        _, found = goals.optimize(goals.plan(goals.chosen(["centred"]), absorb=absorb))
    first = found.first or {}
    off = math.hypot(*(first.get(f"cam.centroid.{axis}", math.nan) for axis in "xy"))
    return off, found.measurements, found.met


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--seat", type=float, nargs="+", default=[1.0, 3.0])
    args = parser.parse_args()
    print("seat  trims        off at first, median [um]   dark   measurements, median / p90 / most   met")
    with tempfile.TemporaryDirectory() as place:
        for seat in args.seat:
            for absorb in (False, True):
                name = "absorb" if absorb else "as they are"
                folder = Path(place) / f"{seat:g}" / name.replace(" ", "_")
                found = [run(folder / str(seed), seed, seat, absorb) for seed in range(1, args.seeds + 1)]
                lit = [off for off, _, _ in found if not math.isnan(off)]
                counts = [count for _, count, _ in found]
                print(f"{seat:4g}  {name:11} {np.median(lit) if lit else math.nan:26.0f} {len(found) - len(lit):6}"
                      f" {np.median(counts):17g} / {np.percentile(counts, 90):.1f} / {max(counts):<9}"
                      f" {sum(met for *_, met in found)} of {len(found)}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
