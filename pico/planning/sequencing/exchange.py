"""Local search: two adjacent stretches of the order change places, as annealing finds it worth while.

Three arcs are replaced; nothing is turned around, so that asymmetric costs are no trouble, and moving one operation or
a stretch of them elsewhere is the same move. It is legal where nothing in the first stretch must stay before something
in the second. Long stretches rarely are, so short ones are tried more often; each move makes one arc that is good by
itself.
"""

from __future__ import annotations

import math
import random
from collections import abc

from pico.planning.sequencing.problem import Masks, Tour

HOT, COLD = 0.6, 0.1
"""First and last temperature, in mean costs of an arc of the first order."""
NEAR = 10
"""How many good successors of an operation are tried."""


def anneal(
    tour: Tour, order: abc.Sequence[int], near: abc.Sequence[abc.Sequence[int]], moves: int, seed: int
) -> tuple[int, ...]:
    """Return the cheapest order met within so many moves from `order`, which must keep the precedence.

    `near`: for each operation, and for the start, good successors, the best first.
    """
    draw, log, arcs, after, count = random.Random(seed).random, math.log, tour.arcs, tour.after, tour.count
    line = [count, *order, count]
    place = _places(line)
    gain, lowest, best = 0.0, 0.0, tuple(order)
    warmth = HOT * abs(tour.cost(order)) / (count + 1)
    cooling = (COLD / HOT) ** (1 / max(1, moves))
    for _ in range(moves):
        warmth *= cooling
        i = int(draw() * (count + 1))
        j = near[i][int(draw() ** 2 * len(near[i]))]
        a, b, c = _stretches(place[i], place[j] if j < count else count + 1, count, draw)
        if not 0 <= a < b < c <= count:
            continue
        i, first, j, second, k, last = line[a], line[a + 1], line[b], line[b + 1], line[c], line[c + 1]
        change = (
            arcs[i][second] + arcs[k][first] + arcs[j][last] - arcs[i][first] - arcs[j][second] - arcs[k][last]
        )  # fmt: skip
        if change > 0 and change >= -warmth * log(1.0 - draw()):
            continue
        if not exchangeable(line[a + 1 : b + 1], line[b + 1 : c + 1], after):
            continue
        line[a + 1 : c + 1] = line[b + 1 : c + 1] + line[a + 1 : b + 1]
        for n in range(a + 1, c + 1):
            place[line[n]] = n
        gain += change
        if gain < lowest:
            lowest, best = gain, tuple(line[1:-1])
    return best


def _places(line: abc.Sequence[int]) -> list[int]:
    place = [0] * (len(line) - 1)
    for n, k in enumerate(line[1:-1], 1):
        place[k] = n
    return place


def _stretches(i: int, j: int, count: int, draw: abc.Callable[[], float]) -> tuple[int, int, int]:
    """Return a, b, c for which exchanging the places a+1..b and b+1..c brings what is at place `j` right after what
    is at `i`; out of order or range where there are none. The third place is drawn, near ones more often."""
    skew = draw() ** 5
    if j > i + 1:
        if draw() < 0.5:
            return i, j - 1, j + int(skew * (count + 1 - j))
        return i - 1 - int(skew * i), i, j - 1
    if j < i:
        length = 1 + int(skew * (i - j))
        return j - 1, (j - 1 + length if draw() < 0.5 else i - length), i
    return 0, 0, 0


def exchangeable(first: abc.Sequence[int], second: abc.Sequence[int], after: Masks) -> bool:
    """Whether the second stretch of an order may come before the first. `after`: transitive."""
    mask = 0
    if len(first) <= len(second):
        for k in second:
            mask |= 1 << k
        return not any(after[k] & mask for k in first)
    for k in first:
        mask |= after[k]
    return not any(mask >> k & 1 for k in second)
