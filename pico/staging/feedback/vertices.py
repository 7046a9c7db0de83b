"""Fewest vertices that meet every cycle of a digraph: reduced, taken apart, and proven by a lazily grown program."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from pico.staging.feedback.clauses import Cover, reached
from pico.staging.feedback.digraph import Digraph, cyclic_components, shortest_cycle, some_cycle
from pico.staging.feedback.heuristic import disjoint_cycles, exchanged, greedy, pruned
from pico.staging.feedback.limit import Limit, Work
from pico.staging.feedback.reductions import Weights, reduce

THREES = 4000
"""Up to so many 3-cycles of one part are demanded from the start."""


@dataclass(frozen=True, slots=True)
class Feedback:
    """Vertices that meet every cycle, sorted, and what no such set can go below.

    Where every choice is forbidden `vertices` is None, `weight` infinite, and `cycle` one that is forbidden throughout.
    """

    vertices: tuple[int, ...] | None
    weight: float
    lower_bound: float
    proven: bool
    cycle: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return len(self.vertices or ())


def fewest_vertices(
    successors: Sequence[Iterable[int]] | Mapping[int, Iterable[int]],
    weights: Mapping[int, float] | None = None,
    forbidden: Collection[int] = (),
    limit: Limit | None = None,
) -> Feedback:
    """Return the cheapest set of vertices without which the digraph has no cycle.

    `weights`: above 0, 1 where none is given; `forbidden` vertices are never chosen. Not `proven`: the best set known
    when the limit was reached, between which and `lower_bound` the cheapest one lies. Raises ValueError for a weight
    that is not above 0.
    """
    limit = limit or Limit()
    named = successors if isinstance(successors, Mapping) else dict(enumerate(successors))
    graph = Digraph.of(sorted(named), ((u, v) for u in sorted(named) for v in named[u]))
    cost = {v: float((weights or {}).get(v, 1.0)) for v in graph.succ}
    if not all(w > 0 for w in cost.values()):
        raise ValueError("weights must be above 0")
    stuck = some_cycle(graph.induced(set(forbidden) & set(graph.succ)).succ)
    if stuck:
        return Feedback(None, float("inf"), float("inf"), True, tuple(stuck))
    for v in sorted(set(forbidden) & set(graph.succ)):
        graph.bypass(v)
    chosen = reduce(graph, cost)
    bound = sum(cost[v] for v in chosen)
    work = limit.work()
    for part in sorted(cyclic_components(graph.succ), key=lambda p: (len(p), p)):
        found, least = _solve_part(graph.induced(part), cost, work, limit)
        chosen += found
        bound += least
    weight = sum(cost[v] for v in chosen)
    proven = reached(weight, bound)
    return Feedback(tuple(sorted(chosen)), weight, weight if proven else bound, proven)


def _solve_part(graph: Digraph, weights: Weights, work: Work, limit: Limit) -> tuple[list[int], float]:
    """Return a feedback vertex set of a reduced strong component, and a lower bound on its weight."""
    best = greedy(graph, weights)
    bound, _ = disjoint_cycles(graph, weights)
    if reached(_cost(weights, best), bound):
        return best, bound
    best = exchanged(graph, weights, best, limit.exchanges)
    names = sorted(graph.succ)
    column = {v: n for n, v in enumerate(names)}
    cover = Cover([weights[v] for v in names])
    for clause, least in _first_clauses(graph):
        cover.at_least([column[v] for v in clause], least)
    while not reached(_cost(weights, best), bound) and not work.spent:
        answer = cover.solve(work, frozenset(column[v] for v in best))
        bound = max(bound, answer.bound)
        if answer.chosen is None:
            break
        cycles, full = _completed(graph, weights, [names[n] for n in answer.chosen])
        for cycle in cycles:
            cover.at_least([column[v] for v in cycle])
        if _cost(weights, full) < _cost(weights, best):
            best = full
    return best, min(bound, _cost(weights, best))


def _cost(weights: Weights, vertices: Iterable[int]) -> float:
    return sum(weights[v] for v in vertices)


def _first_clauses(graph: Digraph) -> Iterator[tuple[tuple[int, ...], int]]:
    """Yield what is demanded from the start: all but one of each clique of 2-cycles, one of each 2- and 3-cycle."""
    near = {v: graph.both_ways(v) for v in graph.succ}
    yield from ((clique, len(clique) - 1) for clique in _cliques(near))
    for _, three in zip(range(THREES), _threes(graph, near), strict=False):
        yield three, 1
    found = set()
    single = {u: graph.succ[u] - near[u] for u in graph.succ}
    for v in single:
        cycle = shortest_cycle(single, v, single)
        if cycle and len(cycle) > 3 and frozenset(cycle) not in found:
            found.add(frozenset(cycle))
            yield tuple(cycle), 1


def _threes(graph: Digraph, near: Mapping[int, set[int]]) -> Iterator[tuple[int, int, int]]:
    """Yield the 3-cycles in which no two vertices form a 2-cycle."""
    single_in = {v: graph.pred[v] - near[v] for v in near}
    for u in near:
        for v in sorted(graph.succ[u] - near[u]):
            if v > u:
                yield from ((u, v, w) for w in sorted((graph.succ[v] - near[v]) & single_in[u]) if w > u)


def _cliques(near: Mapping[int, set[int]]) -> list[tuple[int, ...]]:
    """Return cliques, as large as they grow by taking the nearest to all, that together hold every edge."""
    left = {(u, v) for u in near for v in near[u] if u < v}
    found = []
    for u, v in sorted(left):
        if (u, v) not in left:
            continue
        clique, common = [u, v], near[u] & near[v]
        while common:
            w = max(common, key=lambda w: (len(near[w] & common), -w))
            clique.append(w)
            common = common & near[w]
        clique.sort()
        left.difference_update((a, b) for n, a in enumerate(clique) for b in clique[n + 1 :])
        found.append(tuple(clique))
    return found


def _completed(graph: Digraph, weights: Weights, chosen: Iterable[int]) -> tuple[list[list[int]], list[int]]:
    """Return short cycles that `chosen` leaves, on several levels, and a feedback vertex set grown from it, pruned."""
    full = list(chosen)
    alive = set(graph.succ) - set(full)
    cycles: dict[frozenset[int], list[int]] = {}
    while True:
        parts = cyclic_components({v: graph.succ[v] & alive for v in sorted(alive)})
        if not parts:
            return list(cycles.values()), pruned(graph, weights, full)
        for part in parts:
            inside, hits = set(part), dict.fromkeys(part, 0)
            for v in part:
                cycle = shortest_cycle(graph.succ, v, inside)
                if cycle:
                    cycles.setdefault(frozenset(cycle), cycle)
                    for w in cycle:
                        hits[w] += 1
            worst = max(part, key=lambda v: (hits[v] / weights[v], -v))
            full.append(worst)
            alive.discard(worst)
