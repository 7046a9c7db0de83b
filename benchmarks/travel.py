"""How short the way of an arm between its operations is: against nearest neighbor, and against a bound.

    python benchmarks/travel.py [--sizes 12 18 50 100] [--densities 0.2 0.4] [--cases 10] [--times] [--moves 1200000]

Discs of 6 to 8 cm lie on a square that they fill to the density given, and have goals drawn in the same way; a move
waits for those of all discs that lie where it ends. Rings are broken by moves to storage beside the table, the disc in
most rings first. Costs are straight distances [cm], from and to a place in front of the table; with --times seconds of
the arm of labs/shel, with the square laid over the half ring that it reaches. Carrying is the same in every order: it
is part of `total`, not of `empty`. Seconds are those of one processor core.
"""

from __future__ import annotations

import argparse
import math
import random
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.manifest.load import load_folder  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.staging.sequencing import Effort, Sequence, best_order  # noqa: E402
from pico.staging.sequencing.nearest import nearest_order  # noqa: E402
from pico.staging.sequencing.problem import read_tour  # noqa: E402

Point = tuple[float, float]
"""A place in shares of the square's side; storage and the arm's rest lie outside of it."""
REST = (0.5, -0.2)
RING = (330.0, 600.0)
"""Distances from the axis of the arm of labs/shel that --times lays the square over [mm]."""


@dataclass(frozen=True)
class Work:
    """Operations: where each picks and places, what it waits for, and the side of the square [cm]."""

    picks: list[Point]
    places: list[Point]
    before: list[set[int]]
    side: float


@dataclass(frozen=True)
class Costs:
    """What `best_order` is asked, and the cost of carrying, which no order changes."""

    start: list[float]
    between: list[list[float]]
    end: list[float]
    carried: float


def scattered(rnd: random.Random, radii: list[float], side: float) -> list[Point]:
    """Return places for discs that touch neither one another nor the edge; starts again where there is no room."""
    while True:
        points: list[Point] = []
        for radius in radii:
            for _ in range(20_000):
                x, y = rnd.uniform(radius, side - radius), rnd.uniform(radius, side - radius)
                if all(math.dist((x, y), p) >= radius + r for p, r in zip(points, radii, strict=False)):
                    points.append((x, y))
                    break
            else:
                break
        if len(points) == len(radii):
            return points


def operations(count: int, density: float, seed: int) -> Work:
    """Return `count` operations: fewer discs, where some must be staged."""
    for discs in range(count, 0, -1):
        rnd = random.Random(f"{discs} {density} {seed}")
        radii = sorted((rnd.uniform(3.0, 4.0) for _ in range(discs)), reverse=True)
        side = math.sqrt(sum(math.pi * r * r for r in radii) / density)
        starts, goals = scattered(rnd, radii, side), scattered(rnd, radii, side)
        waits = [
            {j for j in range(discs) if j != i and math.dist(goals[i], starts[j]) < radii[i] + radii[j]}
            for i in range(discs)
        ]
        staged = broken(waits)
        if discs + len(staged) <= count:
            return listed(starts, goals, waits, staged, side)
    raise ValueError(f"no {count} operations at density {density}")


def broken(waits: list[set[int]]) -> list[int]:
    """Return discs to stage so that no ring is left, greedily."""
    staged: list[int] = []
    while True:
        left = {i: waits[i] - set(staged) for i in range(len(waits)) if i not in staged}
        while True:
            waited = set().union(*(left[i] & left.keys() for i in left))
            loose = [i for i in left if not left[i] & left.keys() or i not in waited]
            if not loose:
                break
            left = {i: w for i, w in left.items() if i not in loose}
        if not left:
            return sorted(staged)
        staged.append(max(left, key=lambda i: (len(left[i] & left.keys()) * sum(i in w for w in left.values()), -i)))


def listed(
    starts: list[Point], goals: list[Point], waits: list[set[int]], staged: list[int], side: float
) -> Work:  # fmt: skip
    """Return the moves of all discs, those of staged ones in two operations."""
    slots = {i: (-8.0, 10.0 * n) for n, i in enumerate(staged)}
    picks, places = list(starts), [slots.get(i, goal) for i, goal in enumerate(goals)]
    picks += [slots[i] for i in staged]
    places += [goals[i] for i in staged]
    arrival = {i: len(goals) + n for n, i in enumerate(staged)}
    before = [set(w) if i not in arrival else set() for i, w in enumerate(waits)]
    before += [waits[i] | {i} for i in staged]
    return Work([share(p, side) for p in picks], [share(p, side) for p in places], before, side)


def share(point: Point, side: float) -> Point:
    """Return a place in shares of the side."""
    return point[0] / side, point[1] / side


def distances(work: Work) -> Costs:
    """Return straight distances [cm]."""

    def way(a: Point, b: Point) -> float:
        return work.side * math.dist(a, b)

    return costs(work, lambda place, pick: way(place or REST, pick or REST), way)


def seconds(motion: ArmMotion) -> Callable[[Work], Costs]:
    """Return what gives the times of the arm of labs/shel [s]."""
    mount = motion.setup.lab.robots["arm1"].mount

    def pose(point: Point) -> Pose:
        reach = RING[0] + (RING[1] - RING[0]) * min(1.0, max(0.0, point[1]))
        angle = math.radians(mount.yaw - 90 + 180 * min(1.0, max(0.0, point[0])))
        return Pose(mount.x + reach * math.cos(angle), mount.y + reach * math.sin(angle), 0.0)

    def empty(place: Point | None, pick: Point | None) -> float:
        return motion.travel("arm1", pose(place) if place else None, pose(pick) if pick else None)

    return lambda work: costs(work, empty, lambda a, b: motion.carry("arm1", "p1", pose(a), pose(b), 0.0))


def costs(
    work: Work, empty: Callable[[Point | None, Point | None], float], carry: Callable[[Point, Point], float]
) -> Costs:
    """Return the tables; None is where the arm rests."""
    return Costs(
        [empty(None, pick) for pick in work.picks],
        [[empty(place, pick) for pick in work.picks] for place in work.places],
        [empty(place, None) for place in work.places],
        sum(carry(pick, place) for pick, place in zip(work.picks, work.places, strict=True)),
    )


@dataclass(frozen=True)
class Result:
    """One case: the order, what nearest neighbor costs, what carrying costs, seconds of processor time."""

    found: Sequence
    nearest: float
    carried: float
    seconds: float

    @property
    def gap(self) -> float:
        """By what share the total is above the bound."""
        return (self.found.cost + self.carried) / (self.found.lower_bound + self.carried) - 1

    @property
    def empty_gap(self) -> float:
        """The same for empty travel alone."""
        return self.found.cost / self.found.lower_bound - 1

    @property
    def saved(self) -> float:
        """By what share empty travel is shorter than nearest neighbor's."""
        return 1 - self.found.cost / self.nearest

    @property
    def saved_total(self) -> float:
        """The same with carrying."""
        return 1 - (self.found.cost + self.carried) / (self.nearest + self.carried)


def solve(work: Work, tables: Callable[[Work], Costs], limit: Effort) -> Result:
    """Order the operations of one case."""
    asked = tables(work)
    tour = read_tour(asked.start, asked.between, asked.end, work.before)
    began = time.process_time()
    found = best_order(asked.start, asked.between, asked.end, work.before, limit=limit)
    return Result(found, tour.cost(nearest_order(tour)), asked.carried, time.process_time() - began)


def main() -> int:
    """Print a line for each size and density."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[12, 18, 50, 100])
    parser.add_argument("--densities", type=float, nargs="+", default=[0.2, 0.4])
    parser.add_argument("--cases", type=int, default=10)
    parser.add_argument("--times", action="store_true", help="seconds of an arm in place of distances")
    parser.add_argument("--moves", type=int, default=Effort().moves, help="exchanges that the local search tries")
    given = parser.parse_args()
    tables = distances
    if given.times:
        tables = seconds(ArmMotion(load_folder(ROOT / "labs" / "shel").require()[0]))
    limit = Effort(moves=given.moves)
    best_order([1, 1], [[0, 1], [1, 0]], [1, 1], [set(), set()], limit=limit)  # what is imported once is not counted
    print("medians (worst)       proven   seconds        gap total        gap empty    saved empty, total")
    for density in given.densities:
        for size in given.sizes:
            done = [solve(operations(size, density, seed), tables, limit) for seed in range(given.cases)]
            print(f"m = {size:3d}, density {density:g}", line(done), flush=True)
    return 0


def line(done: list[Result]) -> str:
    """Return the figures of one size and density."""

    def spread(values: list[float], scale: float, digits: int) -> str:
        return f"{scale * statistics.median(values):.{digits}f} ({scale * max(values):.{digits}f})"

    proven = sum(r.found.proven for r in done)
    saved = [100 * statistics.median(values) for values in ([r.saved for r in done], [r.saved_total for r in done])]
    return (
        f"{proven:4d}/{len(done)}  {spread([r.seconds for r in done], 1, 3)}  {spread([r.gap for r in done], 100, 2)} %"
        f"  {spread([r.empty_gap for r in done], 100, 1)} %  {saved[0]:.1f} %, {saved[1]:.1f} %"
    )


if __name__ == "__main__":
    sys.exit(main())
