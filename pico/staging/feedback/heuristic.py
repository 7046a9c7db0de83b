"""Feedback vertex sets without proof: greedy by degree, pruned, improved by exchanging; and disjoint cycles below."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable

from pico.staging.feedback.digraph import Digraph, cyclic_components, shortest_cycle, topological_order
from pico.staging.feedback.reductions import Weights, reduce


def greedy(graph: Digraph, weights: Weights) -> list[int]:
    """Return a feedback vertex set: again and again the vertex with the most cycles through it for its weight, as far
    as degrees tell, then without those that turn out to be needless."""
    rest = graph.induced(graph.succ)
    taken = reduce(rest, weights, thorough=False)
    while rest.succ:
        best = max(rest.succ, key=lambda v: (len(rest.succ[v]) * len(rest.pred[v]) / weights[v], -v))
        taken.append(best)
        rest.remove(best)
        taken += reduce(rest, weights, thorough=False)
    return pruned(graph, weights, taken)


def pruned(graph: Digraph, weights: Weights, taken: Iterable[int]) -> list[int]:
    """Return a feedback vertex set without the vertices that it does not need, the costliest left out first."""
    kept = set(taken)
    alive = set(graph.succ) - kept
    for v in sorted(kept, key=lambda v: (-weights[v], v)):
        alive.add(v)
        if shortest_cycle(graph.succ, v, alive):
            alive.discard(v)
        else:
            kept.discard(v)
    return sorted(kept)


def exchanged(graph: Digraph, weights: Weights, taken: list[int], moves: int, seed: int = 0) -> list[int]:
    """Return a feedback vertex set found from `taken` by simulated annealing over orders of the vertices kept: a vertex
    comes in at a place, those come out that then stand on the wrong side of it (Galinier, Lemamou and Bouzidi, 2013).
    """
    rng = random.Random(seed)
    out = sorted(taken)
    order = topological_order(graph.induced(set(graph.succ) - set(out)).succ)
    place = {v: n for n, v in enumerate(order)}
    best, cost, lowest = list(out), 0.0, 0.0
    scale = min(weights[v] for v in graph.succ)
    for move in range(moves):
        if not out:
            return best
        heat = 0.6 * scale * (1 - move / moves) ** 2 + 1e-9
        n = int(rng.random() * len(out))
        v = out[n]
        at, lost = _insertion(graph, place, v, rng.random() < 0.5)
        change = sum(weights[w] for w in lost) - weights[v]
        if change > 0 and rng.random() >= math.exp(-change / heat):
            continue
        out[n] = out[-1]
        out.pop()
        out += lost
        order.insert(at, v)
        gone = set(lost)
        order = [w for w in order if w not in gone]
        place = {w: n for n, w in enumerate(order)}
        cost += change
        if cost < lowest - 1e-9:
            best, lowest = sorted(out), cost
    return best


def _insertion(graph: Digraph, place: dict[int, int], v: int, early: bool) -> tuple[int, list[int]]:
    """Return where to insert `v`, just behind all of its predecessors or before all of its successors, and which of the
    others must go for it."""
    before = [(place[u], u) for u in graph.pred[v] if u in place]
    after = [(place[w], w) for w in graph.succ[v] if w in place]
    if early:
        at = min(after)[0] if after else len(place)
        return at, sorted(u for n, u in before if n >= at)
    at = max(before)[0] + 1 if before else 0
    return at, sorted(w for n, w in after if n < at)


def disjoint_cycles(graph: Digraph, weights: Weights) -> tuple[float, list[list[int]]]:
    """Return a lower bound on the weight of every feedback vertex set, and the cycles that it rests on: the sum of what
    each of them must cost, with no vertex charged twice for more than its weight."""
    left = {v: weights[v] for v in graph.succ}
    alive = set(graph.succ)
    bound, found = 0.0, []
    for length in (2, 3, len(alive)):
        for part in cyclic_components({v: graph.succ[v] & alive for v in sorted(alive)}):
            for v in sorted(part, key=lambda v: (len(graph.succ[v]) * len(graph.pred[v]), v)):
                while v in alive and (cycle := shortest_cycle(graph.succ, v, alive)) and len(cycle) <= length:
                    price = min(left[w] for w in cycle)
                    bound += price
                    found.append(cycle)
                    for w in cycle:
                        left[w] -= price
                        if left[w] <= 1e-12:
                            alive.discard(w)
    return bound, found
