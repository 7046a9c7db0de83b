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

from pico.staging.sequencing.problem import Masks, Tour

HOT, COLD = 0.6, 0.1
"""First and last temperature, in mean costs of an arc of the first order."""
CLEAR = 0.5
"""By how many temperatures the arc that a move makes may be dearer than the one that it replaces: few dearer ones are
worth while, and looking at them takes time that others use better."""
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
    good = [[j if j < count else count + 1 for j in row] for row in near]
    gain, lowest, best = 0.0, 0.0, tuple(order)
    warmth = HOT * abs(tour.cost(order)) / (count + 1)
    cooling = (COLD / HOT) ** (1 / max(1, moves))
    for _ in range(moves):
        warmth *= cooling
        i = int(draw() * (count + 1))
        row = good[i]
        p, q, skew = place[i], place[row[int(draw() ** 2 * len(row))]], draw() ** 5
        old = arcs[line[p]]
        if old[line[q]] - old[line[p + 1]] > CLEAR * warmth:
            continue
        if q > p + 1:  # what is at place q comes right after what is at p: by itself, or with what is behind it
            if draw() < 0.5:
                a, b, c = p, q - 1, q + int(skew * (count + 1 - q))
            else:
                a, b, c = p - 1 - int(skew * p), p, q - 1
        elif q < p:
            length = 1 + int(skew * (p - q))
            a, b, c = q - 1, (q - 1 + length if draw() < 0.5 else p - length), p
        else:
            continue
        if not 0 <= a < b < c <= count:
            continue
        first, second, last = line[a + 1], line[b + 1], line[c + 1]
        out, mid, end = arcs[line[a]], arcs[line[b]], arcs[line[c]]
        change = out[second] + end[first] + mid[last] - out[first] - mid[second] - end[last]
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
    """Return at what place of the line each operation is, and the start; behind them that of the park."""
    place = [0] * len(line)
    place[-1] = len(line) - 1
    for n, k in enumerate(line[1:-1], 1):
        place[k] = n
    return place


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
