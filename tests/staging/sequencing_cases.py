"""Random ordering problems, and their answers by trying every order."""

from __future__ import annotations

import random
from dataclasses import dataclass

from pico.staging.sequencing.problem import Tour, read_tour


@dataclass(frozen=True)
class Instance:
    """What `best_order` is asked."""

    start: list[float]
    between: list[list[float]]
    end: list[float]
    before: list[set[int]]

    @property
    def tour(self) -> Tour:
        return read_tour(self.start, self.between, self.end, self.before)


def instance(count: int, density: float, seed: int, most: int = 50) -> Instance:
    """Return a problem with whole costs; a pair is ordered with probability `density`, so that some order works."""
    rnd = random.Random(f"{count} {density} {seed}")
    hidden = rnd.sample(range(count), count)
    before: list[set[int]] = [set() for _ in range(count)]
    for n, j in enumerate(hidden):
        before[j] = {i for i in hidden[:n] if rnd.random() < density}

    def costs() -> list[float]:
        return [float(rnd.randint(0, most)) for _ in range(count)]

    return Instance(costs(), [costs() for _ in range(count)], costs(), before)


def keeps(order: tuple[int, ...], before: list[set[int]]) -> bool:
    """Whether an order holds every operation once, each after what it waits for."""
    place = {k: n for n, k in enumerate(order)}
    complete = sorted(order) == list(range(len(before)))
    return complete and all(place[e] < place[j] for j, earlier in enumerate(before) for e in earlier)


def cheapest(given: Instance) -> float:
    """Return the least cost of all orders, by trying them."""
    count = len(given.start)
    best = float("inf")

    def extend(done: set[int], last: int | None, cost: float) -> None:
        nonlocal best
        if len(done) == count:
            best = min(best, cost + (given.end[last] if last is not None else 0.0))
        for j in range(count):
            if j not in done and given.before[j] <= done:
                step = given.start[j] if last is None else given.between[last][j]
                extend(done | {j}, j, cost + step)

    extend(set(), None, 0.0)
    return best
