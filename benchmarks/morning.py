"""Nights in which one hidden thing happens to a bench, or none, and what `pico morning` makes of them.

The bench is `morning_lab.py`, in the kinematic twin, its world drifting by itself overnight. Each night is drawn by a
seed: how long it is, and of the twelve kinds of fault below the part, the size and the direction. Printed are, for each
kind, how often the right part came first, and how often it was first or one that no reading can tell from the first;
how often a probability that was told came true; and how many of the quiet nights raised an alarm.

    python benchmarks/morning.py [--nights 50] [--faults 10]
"""

from __future__ import annotations

import argparse
import math
import random
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import morning_lab

import pico
from pico.backends.sim.store import load_world, save_world
from pico.bench.bench import Bench
from pico.bench.mornings import Morning
from pico.diagnosis.suspects import NOTHING
from pico.places.bench import BenchPlace

Draw = random.Random
Fault = Callable[[Bench, Draw], str]
"""Lets something happen to a bench, and returns the part that it happened to."""


def size(draw: Draw, low: float, high: float) -> float:
    """Return a size between two, evenly in its logarithm."""
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def signed(draw: Draw, low: float, high: float) -> float:
    """Return the same, up or down."""
    return draw.choice((-1, 1)) * size(draw, low, high)


def slips(tunables: tuple[str, ...], low: float, high: float, sign: float = 0.0) -> Fault:
    """Return the fault of an axis whose zero slips."""

    def happen(bench: Bench, draw: Draw) -> str:
        part, _, tunable = draw.choice(tunables).partition(".")
        bench.sim.slip(part, tunable, sign * size(draw, low, high) if sign else signed(draw, low, high))
        return part

    return happen


def upsets(parts: tuple[str, ...], what: str, low: float, high: float) -> Fault:
    """Return the fault of a part with one number."""

    def happen(bench: Bench, draw: Draw) -> str:
        part, by = draw.choice(parts), size(draw, low, high)
        factor = {"gain": math.exp(draw.choice((-1, 1)) * by), "power": 1 - by}
        bench.sim.upset(part, **{what: factor.get(what, by)})
        return part

    return happen


def moves(parts: tuple[str, ...], one: str, other: str, low: float, high: float) -> Fault:
    """Return the fault of a part that is displaced or turned in some direction."""

    def happen(bench: Bench, draw: Draw) -> str:
        part, by, way = draw.choice(parts), size(draw, low, high), draw.uniform(0, 2 * math.pi)
        bench.sim.upset(part, **{one: by * math.cos(way), other: by * math.sin(way)})
        return part

    return happen


OPTICS = ("hwp", "p1", "lx_125", "p2", "ly_150")
KINDS: dict[str, Fault] = {
    "polarizer zero slipped": slips(("p1.angle", "p2.angle"), 0.2, 2.0),
    "wave plate zero slipped": slips(("hwp.angle",), 0.2, 2.0),
    "polarizer leaks": upsets(("p1", "p2"), "leak", 2e-4, 3e-3),
    "lens moved below sight": moves(("lx_125", "ly_150"), "left", "up", 0.03, 0.15),
    "stage zero slipped": slips(("ly_150.stage_y", "ly_150.stage_z"), 0.03, 0.15),
    "laser power down": upsets(("laser",), "power", 0.05, 0.3),
    "laser points elsewhere": moves(("laser",), "yaw", "pitch", 0.003, 0.017),
    "dirt on an optic": upsets(OPTICS, "loss", 0.03, 0.3),
    "camera hot": upsets(("cam",), "dark", 20.0, 500.0),
    "camera bumped": moves(("cam",), "left", "up", 0.02, 0.15),
    "camera gain changed": upsets(("cam",), "gain", 0.03, 0.2),
    "iris closed a little": slips(("iris.opening",), 0.1, 0.5, -1.0),
}


def by_part(found: Morning) -> list[tuple[str, float]]:
    """Return the parts by the probability that something happened to them, all that it may be taken together."""
    sums: dict[str, float] = {}
    for one in found.suspects:
        if one.part:
            sums[one.part] = sums.get(one.part, 0.0) + one.probability
    return sorted(sums.items(), key=lambda item: -item[1])


def night(bench: Bench, root: Path, draw: Draw, fault: Fault | None) -> tuple[Morning, str]:
    """Let a night pass, and something happen in it; return the morning after it, and the part. Afterwards the fault is
    gone, and the time has passed."""
    bench.sim.wait(3600 * draw.uniform(8, 16))
    before = load_world(bench.setup, BenchPlace(root, "sim"))[0]
    part = fault(bench, draw) if fault else ""
    found = bench.morning()
    after = load_world(bench.setup, BenchPlace(root, "sim"))[0]
    save_world(BenchPlace(root, "sim"), replace(after, components=before.components))
    return found, part


@dataclass
class Tally:
    """Of one kind: how often the right part came first, and was first or one that no reading tells from the first."""

    right: int = 0
    like: int = 0
    many: int = 0


@dataclass
class Told:
    """What many nights gave: `tallies` by kind, the probability of the part that came first with whether it was right,
    the quiet nights and those that raised an alarm, and the longest morning [s]."""

    tallies: dict[str, Tally]
    told: list[tuple[float, bool]]
    quiet: int = 0
    alarms: int = 0
    longest: float = 0.0

    def judge(self, kind: str, found: Morning, part: str) -> None:
        """Count a night in which something happened."""
        parts, top = by_part(found), next(s for s in found.suspects if s.kind != NOTHING)
        first = bool(parts) and parts[0][0] == part
        self.longest = max(self.longest, found.seconds)
        mine = self.tallies.setdefault(kind, Tally())
        mine.many += 1
        mine.right += found.unusual and first
        mine.like += found.unusual and (first or part in top.like)
        self.told.append((parts[0][1] if parts else 0.0, first))

    def judge_quiet(self, number: int, found: Morning) -> None:
        """Count a night in which nothing happened."""
        self.quiet += 1
        self.longest = max(self.longest, found.seconds)
        if found.unusual:
            self.alarms += 1
            lost = ", ".join(r.name for r in found.readings if r.then is not None and r.now is None)
            first = next((f"{s.part} {s.kind}" for s in found.suspects if s.kind != NOTHING), "")
            print(f"  quiet night {number}: {first}{f', not read: {lost}' if lost else ''}", flush=True)

    def show(self) -> None:
        """Print all of it."""
        for kind, mine in self.tallies.items():
            print(f"{kind:25} right part first {mine.right:2} of {mine.many}, or not to be told from it {mine.like:2}")
        right, like, many = (sum(getattr(t, n) for t in self.tallies.values()) for n in ("right", "like", "many"))
        if many:
            print(f"\nright part first in {right} of {many} ({100 * right / many:.0f} %), ", end="")
            print(f"or not to be told from it in {like} ({100 * like / many:.0f} %)")
        for low, high in ((0.0, 0.3), (0.3, 0.6), (0.6, 0.9), (0.9, 1.01)):
            own = [(p, ok) for p, ok in self.told if low <= p < high]
            if own:
                mean, true = sum(p for p, _ in own) / len(own), sum(ok for _, ok in own)
                print(f"told with {100 * mean:.0f} % on average: true in {true} of {len(own)}")
        print(f"{self.alarms} false alarms in {self.quiet} quiet nights")
        print(f"the longest morning took {self.longest:.0f} s of the bench", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nights", type=int, default=50, help="quiet ones")
    parser.add_argument("--faults", type=int, default=10, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    found = Told({}, [])
    rounds = args.faults or 1
    with tempfile.TemporaryDirectory() as place:
        root = Path(place) / "lab"
        morning_lab.make(root, args.seed)
        with pico.open(root, fidelity="kinematic") as bench:
            bench.apply()
            bench.sim.wait(7200)  # the laser is warm
            first = bench.morning(accept=True)
            print(f"a morning takes {first.seconds:.0f} s of the bench, {len(first.readings)} quantities", flush=True)
            for number in range(rounds):  # some of each kind and quiet ones in each round, so that any time tells
                for kind, fault in KINDS.items() if number < args.faults else ():
                    found.judge(kind, *night(bench, root, Draw(f"{args.seed}/{kind}/{number}"), fault))
                for quiet in range(args.nights * number // rounds, args.nights * (number + 1) // rounds):
                    found.judge_quiet(quiet, night(bench, root, Draw(f"{args.seed}/quiet/{quiet}"), None)[0])
                print(f"-- after round {number + 1} of {rounds}", flush=True)
                found.show()


if __name__ == "__main__":
    main()
