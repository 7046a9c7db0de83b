"""A polarizer that is mounted anew, and brought back to where light says that it belongs.

The manifest has `angle: {null_of: [p1, p2], offset: 1.0}`. For each seed the case study's bench is made anew, in a
world that drifts and with noise; light finds the set-point once; then the mount of one of the two polarizers, or of
each, slips by up to 3 degrees, of which no axis reads anything; of every fourth bench the power is off meanwhile, and
its axes are homed. `pico optimize p2.angle` follows. Printed is how far the polarizer then truly stands from the true
null of both plus the offset: where the least light would pass, traced without noise. Nothing of the program sees that.

    python benchmarks/null_of.py [--seeds 40] [--reach 3]
"""

from __future__ import annotations

import argparse
import math
import random
import tempfile
from collections.abc import Callable
from pathlib import Path

import pico
from pico.backends.sim.lighted import light_on
from pico.backends.sim.readings import Table
from pico.backends.sim.store import load_world
from pico.bench.bench import Bench, new_lab
from pico.places.bench import BenchPlace

NEAR = 0.02
"""How near is near enough [deg]."""
OFFSET = 1.0
_GOLDEN = (math.sqrt(5) - 1) / 2


def least(of: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function with one valley is least, to 1e-5."""
    while high - low > 1e-5:
        a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        low, high = (low, b) if of(a) < of(b) else (a, high)
    return (low + high) / 2


def true_error(bench: Bench, folder: Path) -> float:
    """Return how far p2 truly stands from the true null of p1 and p2 plus the offset [deg]."""
    world = load_world(bench.setup, BenchPlace(folder, "sim"))[0]
    body = world.components["p2"]
    stands = float(body.true_values["angle"])

    def power(at: float) -> float:
        turned = world.with_body("p2", offsets={**body.offsets, "angle": at - float(body.values["angle"].value or 0.0)})
        return sum(
            arrival.power for arrival in light_on(Table(bench.setup, BenchPlace(folder, "sim"), turned)).at("cam")
        )

    guess = float(world.components["p1"].true_values["angle"]) + 90
    null = least(power, guess - 5, guess + 5)
    return (stands - null - OFFSET + 90) % 180 - 90


def run(folder: Path, seed: int, reach: float) -> tuple[float, int, bool, float]:
    """Return how far p2 is from where it belongs [deg], how far it was after the slip, the measurements, and whether
    the program said that the goal is met."""
    draw = random.Random(seed)
    new_lab(folder, "shel")
    lab, state = folder / "lab.yaml", folder / "state" / "table.yaml"
    lab.write_text(lab.read_text().replace("  seed: 1\n", f"  seed: {seed}\n"))
    text = state.read_text()
    at = text.index("angle:", text.index("\n  p2:"))
    line = text[at : text.index("\n", at)]
    reference = f"angle: {{null_of: [p1, p2], offset: {OFFSET}}}"
    state.write_text(text[:at] + reference + text[at + len(line) :])
    with pico.open(folder) as bench:
        bench.apply()
        bench.optimize("p2.angle")
        for name in ("p1", "p2") if seed % 3 == 0 else ("p2",) if seed % 3 == 1 else ("p1",):
            bench.sim.slip(name, "angle", draw.uniform(-reach, reach))
        if seed % 4 == 0:
            bench.sim.power_cycle()
            bench.apply()
            for _ in bench.run(bench.single("p2", "home", tunable="angle")):
                pass
        before = true_error(bench, folder)
        found = bench.optimize("p2.angle")
        return true_error(bench, folder), found.measurements, found.met, before


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--reach", type=float, default=3.0, help="how far a mount slips at most [deg]")
    args = parser.parse_args()
    found = []
    with tempfile.TemporaryDirectory() as place:
        for seed in range(1, args.seeds + 1):
            found.append(run(Path(place) / str(seed), seed, args.reach))
            error, count, met, before = found[-1]
            said = "met" if met else "not met"
            print(
                f"seed {seed:3}: {before:+8.3f} deg before, {error:+.4f} after {count:2} measurements, {said}",
                flush=True,
            )
    good = sum(met and abs(error) <= NEAR for error, _, met, _ in found)
    counts, worst = sorted(f[1] for f in found), max(abs(f[0]) for f in found)
    print(f"\n{good} of {len(found)} within {NEAR:g} deg of the true null plus {OFFSET:g} deg; worst {worst:.4f} deg; "
          f"measurements: median {counts[len(counts) // 2]}, most {counts[-1]}")  # fmt: skip


if __name__ == "__main__":
    main()
