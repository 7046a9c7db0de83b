"""The case study whole, by its recipe, seed after seed: what was measured beside the theory of the bench as it stood.

Each seed is a new world, in which `recipes/shel.yaml` runs from C1 to its end: three lens pairs, ten tilts, states
restored, nine shifts measured again. Printed are how many of the shifts lie within two combined standard deviations of
theory, and chi-squared per degree of freedom; the error budget stands in `recipes/shel/shift.yaml`, was written before
the first run, and is fitted to nothing. The paper's repeatability of 3.87 um is printed beside what the budget
predicts, as information.

    python benchmarks/shel.py [--seeds 20] [--first 1] [--fidelity kinematic] [--only TILT]
"""

from __future__ import annotations

import argparse
import math
import os
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command has it

from pico.bench.bench import Bench
from pico.history.examples.example import make_example
from pico.recipes.recipes import Recipes

PAPER = 3.87
"""The paper's repeatability [um]."""


def returned(folder: Path, seed: int, fidelity: str, given: Mapping[str, str]) -> Mapping[str, Any]:
    """Return what the recipe returns in a new world; raises SystemExit where it fails."""
    make_example("shel", folder)
    with Bench.open(folder, fidelity=fidelity) as bench:
        bench.sim.reset(seed)
        recipes = Recipes(bench)
        recipe = recipes.read("shel")
        found = recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, given)))
    if found.outcome != "done":
        raise SystemExit(f"seed {seed}: {found.outcome} at {found.at}: {[d.summary for d in found.diagnostics]}")
    return found.returns


def shifts(found: Mapping[str, Any]) -> list[tuple[float, float, float]]:
    """Return each shift with its standard deviation and what theory says [um]."""
    rows = []
    for of in ("e1", "e2", "e3", "again"):
        y, sigma, theory = (found[f"{of}_{what}"] for what in ("y", "sigma", "theory"))
        rows += list(zip(y, sigma, theory, strict=True)) if isinstance(y, list) else [(y, sigma, theory)]
    return rows


def main() -> None:
    """Run the seeds, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--fidelity", choices=("physics", "kinematic"), default="physics")
    parser.add_argument("--only", metavar="TILT", help="this tilt alone, and nothing of it again, to try the benchmark")
    args = parser.parse_args()
    given = {"tilts": f"[{args.only}]", "again": f"[{args.only}]"} if args.only else {}
    every: list[tuple[float, float, float]] = []
    for seed in range(args.first, args.first + args.seeds):
        with tempfile.TemporaryDirectory(prefix="pico-shel-") as place:
            began = time.monotonic()
            rows = shifts(returned(Path(place) / "shel", seed, args.fidelity, given))
        every += rows
        chi = sum(((y - t) / s) ** 2 for y, s, t in rows) / len(rows)
        near = sum(abs(y - t) <= 2 * s for y, s, t in rows)
        print(f"seed {seed:3}: {near} of {len(rows)} within 2 sigma, chi2/dof {chi:.2f}, "
              f"{time.monotonic() - began:.0f} s", flush=True)  # fmt: skip
    chi = sum(((y - t) / s) ** 2 for y, s, t in every) / len(every)
    near = sum(abs(y - t) <= 2 * s for y, s, t in every) / len(every)
    mean = math.sqrt(sum(s * s for _, s, _ in every) / len(every))
    print(f"\n{100 * near:.0f} % of {len(every)} shifts within 2 combined sigma (bar 90 %), chi2/dof {chi:.2f} "
          f"(bar 0.7 to 1.4); {args.fidelity}")  # fmt: skip
    print(f"the budget predicts {mean:.2f} um (root mean square of sigma); the paper's repeatability is {PAPER} um")


if __name__ == "__main__":
    main()
