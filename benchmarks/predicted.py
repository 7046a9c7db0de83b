"""Do times come true? Plans of the shipped labs, and how long their runs then take in the physical twin, by sight.

    python benchmarks/predicted.py [--transitions 30] [--labs labs/shel labs/crowded labs/minimal labs/two_arms]
                                   [--tool 1000] [--seed 1]

Each transition brings random parts to random free slots, from where the last one left the bench. Printed are the ratios
of executed and predicted seconds, and their median, 95th percentile and mean signed error. `--tool` limits the speed of
the tool [mm/s]. Exit code 1 where the median is off by more than 3 %, the 95th percentile by more than 10 %, or the
mean by more than 2 %.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command has it
ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "execution")]

from benches import apply, sim  # noqa: E402

from pico.manifest.load import load_folder  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.state import ComponentState, LabState, home_state, place_of  # noqa: E402

LABS = [ROOT / "labs" / name for name in ("shel", "crowded", "minimal", "two_arms")]


def seen_bench(lab: Path, tool: float) -> Setup:
    """Return a lab that is looked at by sight, if it has the cameras, its tools no faster than `tool` [mm/s]."""
    setup = load_folder(lab).require()[0]
    eyes = {camera.robot for camera in setup.lab.cameras.values()}
    looks = {None, *setup.lab.robots} <= eyes
    robots = {n: replace(r, tool_speed=min(r.fastest, tool)) for n, r in setup.lab.robots.items()}
    settings = replace(setup.lab.sim, observe="sight", sight="pixels") if looks else setup.lab.sim
    return replace(setup, lab=replace(setup.lab, robots=robots, sim=settings))


def shuffled(setup: Setup, state: LabState, rnd: random.Random) -> LabState:
    """Return the state with one to four parts elsewhere."""
    parts = [n for n in sorted(setup.lab.inventory) if setup.movable(n)]
    taken = {place_of(setup, state, n)[0] for n in parts}
    free = [slot for slot in sorted(setup.lab.slots) if slot not in taken]
    chosen = rnd.sample(parts, min(len(parts), len(free), rnd.randint(1, 4)))
    moved = {n: ComponentState(slot=slot) for n, slot in zip(chosen, rnd.sample(free, len(chosen)), strict=True)}
    return replace(state, components={**state.components, **moved})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--transitions", type=int, default=30)
    parser.add_argument("--labs", type=Path, nargs="+", default=LABS)
    parser.add_argument("--tool", type=float, default=1000.0)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    ratios: list[float] = []
    for lab in given.labs:
        setup, rnd = seen_bench(lab, given.tool), random.Random(given.seed)
        count = -(-given.transitions // len(given.labs))
        with tempfile.TemporaryDirectory() as folder:
            state = home_state(setup)
            for number in range(count):
                wanted, edge = shuffled(setup, state, rnd), sim(setup, Path(folder), fidelity="physics")
                plan, result, _ = apply(edge, wanted, f"r{number}")
                took = result.seconds
                if result.outcome != "done" or not plan.makespan:
                    print(f"{setup.lab.name}: left out, {result}"[:200])
                    continue
                state = wanted
                ratios.append(took / plan.makespan)
                moves = sum(operation.kind.carries for operation in plan.operations)
                print(f"{setup.lab.name}: {moves} moves, {plan.makespan:.1f} s predicted, {took:.1f} s executed")
    errors = sorted(abs(ratio - 1) for ratio in ratios)
    median, p95 = statistics.median(errors), errors[min(len(errors) - 1, int(0.95 * len(errors)))]
    mean = statistics.mean(ratios) - 1
    print(f"{len(ratios)} transitions: off by {median:.1%} (median), {p95:.1%} (p95), {mean:+.1%} in the mean")
    return int(median > 0.03 or p95 > 0.10 or abs(mean) > 0.02)


if __name__ == "__main__":
    sys.exit(main())
