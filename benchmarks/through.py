"""Two mirrors that are mounted anew, and bring their beam through two irises again.

The manifest has `{through: [near, far]}` for tip and tilt of both. For each seed a bench is made anew, in a world that
drifts and with noise: the arm puts the mirrors down, each off in all six ways by what the catalog says of its seat, and
`pico apply --align` finds the set-points. Then the arm takes both mirrors to storage; the zero of each axis slips there
by up to 1 mrad, of which no axis reads anything; of every third bench one of them is exchanged for a spare one; of
every fourth the power is off meanwhile, and its axes are homed. `pico apply` puts them back, with other errors of
their seats, and `pico apply --align` brings light through both irises. Printed is how far beside the middle of each
iris the beam then truly passes, traced without noise, and how far before the light was sought. Nothing of the program
sees that.

    python benchmarks/through.py [--seeds 20] [--slip 1]
"""

from __future__ import annotations

import argparse
import random
import tempfile
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import pico
from pico.backends.sim.lighted import unseen_of
from pico.backends.sim.store import load_world
from pico.bench import updating
from pico.bench.bench import Bench
from pico.optics.environment import in_the_world
from pico.optics.light import light_of
from pico.optics.offsets import Place, offset
from pico.places.bench import BenchPlace

NEAR = 0.2
"""How near the middle of each iris is near enough [mm]: a third of the beam's radius there."""
MIRRORS, AXES = ("m1", "m2"), ("tip", "tilt")
LAB = """\
apiVersion: pico/v1
kind: Lab
metadata: {{name: irises, title: Two mirrors and two irises}}
table: {{size: [1500, 900], beam_height: 70}}
slots:
  storage/a1: {{x: 250, y: 560}}
  storage/a2: {{x: 340, y: 560}}
robots:
  arm1: {{model: xarm7, mount: {{x: 600, y: 850, yaw: -90}}, transit_height: 250}}
policy: {{enclosed: true, arming: {{waived: [kinematic]}}}}
sim: {{fidelity: kinematic, seed: {seed}, errors: {{seat: 1}}}}
inventory:
  laser: {{type: hene_laser_expanded, pose: {{x: 120, y: 260, yaw: 0}}}}
  weak: {{type: neutral_density_filter, pose: {{x: 260, y: 260, yaw: 0}}}}
  m1: {{type: mirror_tip_tilt, marker: 1, serial: A1, home: storage/a1}}
  m2: {{type: mirror_tip_tilt, marker: 2, serial: A2, home: storage/a2}}
  near: {{type: iris, pose: {{x: 560, y: 440, yaw: 0}}}}
  far: {{type: iris, pose: {{x: 1000, y: 440, yaw: 0}}}}
  meter: {{type: power_meter, pose: {{x: 1200, y: 440, yaw: 0}}}}
"""
STATE = """\
apiVersion: pico/v1
kind: LabState
metadata: {lab: irises}
components:
  laser: {emission: true, shutter: open}
  m1: {pose: {x: 400, y: 260, yaw: -45}, tip: {through: [near, far]}, tilt: {through: [near, far]}}
  m2: {pose: {x: 400, y: 440, yaw: 135}, tip: {through: [near, far]}, tilt: {through: [near, far]}}
  near: {opening: 11.5}
  far: {opening: 11.5}
  meter: {wavelength: 632.8}
"""


@dataclass(frozen=True)
class Found:
    """How far beside the irises the beam passes at most, `before` the light was sought and `after` it [mm];
    measurements; and whether the program says that the goal is met, and aligned afterwards."""

    before: float
    after: float
    measurements: int
    met: bool


def beside(bench: Bench, folder: Path) -> float:
    """Return how far beside the middle of an iris the beam truly passes, of the worse one [mm]."""
    setup = bench.setup
    world = load_world(setup, BenchPlace(folder, "sim"))[0]
    standing = {n: b for n, b in world.components.items() if b.presence == "seen" and b.pose is not None}
    poses = {n: b.pose for n, b in standing.items() if b.pose is not None}
    unseen = {n: one for n, b in standing.items() if (one := unseen_of(setup, n, b))}
    values = {n: {k: v for k, v in b.true_values.items() if k != "opening"} for n, b in standing.items()}
    light = light_of(setup, *in_the_world(setup, poses, values, world.seed, world.clock), unseen=unseen)
    found = [offset(light, Place(iris, by=frozenset(MIRRORS))) for iris in ("near", "far")]
    return max(float("inf") if one is None else float(abs(one[:2]).max()) for one in found)


def mounted_anew(folder: Path, seed: int, slip: float) -> None:
    """Take the mirrors to storage, and let happen to them there what the benchmark says."""
    draw = random.Random(seed)
    with pico.open(folder) as bench:
        bench.apply(bench.plans.moving({"m1": "storage/a1", "m2": "storage/a2"}))
        for mirror, axis in product(MIRRORS, AXES):
            bench.sim.slip(mirror, axis, draw.uniform(-slip, slip))
        if seed % 4 == 0:
            bench.sim.power_cycle()
    if seed % 3 == 0:
        spare = MIRRORS[seed % 2]
        updating.swap(BenchPlace(folder, "sim"), updating.swapped(BenchPlace(folder, "sim"), spare, "B1", None, {}))


def run(folder: Path, seed: int, slip: float) -> Found:
    """Let light find the set-points, mount the mirrors anew, and let it find them again."""
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text(LAB.format(seed=seed))
    (folder / "state" / "table.yaml").write_text(STATE)
    with pico.open(folder) as bench:
        bench.apply(bench.plan(align=True))
    mounted_anew(folder, seed, slip)
    with pico.open(folder) as bench:
        bench.apply()
        before = beside(bench, folder)
        report = bench.apply(bench.plan(align=True))
        (end,), (stands,) = report.goals or (), bench.goals.alignments()
        return Found(before, beside(bench, folder), end.measurements, end.met and stands.status == "aligned")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--slip", type=float, default=1.0, help="how far the zero of an axis slips at most [mrad]")
    args = parser.parse_args()
    found = []
    with tempfile.TemporaryDirectory() as place:
        for seed in range(1, args.seeds + 1):
            one = run(Path(place) / str(seed), seed, args.slip)
            found.append(one)
            said = "met" if one.met else "not met"
            print(f"seed {seed:3}: {one.before:6.2f} mm before, {one.after:.3f} after "
                  f"{one.measurements:3} measurements, {said}", flush=True)  # fmt: skip
    good, counts = sum(one.met and one.after <= NEAR for one in found), sorted(one.measurements for one in found)
    print(f"\n{good} of {len(found)} within {NEAR:g} mm of the middles of both irises; worst "
          f"{max(one.after for one in found):.3f} mm; measurements: median {counts[len(counts) // 2]}, "
          f"most {counts[-1]}")  # fmt: skip


if __name__ == "__main__":
    main()
