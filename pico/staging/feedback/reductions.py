"""Reductions of the feedback vertex set problem: what must be taken, what never need be, what lies on no cycle.

In/out-degree 0 and 1 and self-loops: Levy and Low (1988). PIE, CORE and DOME: Lin and Jou (2000). All in the weighted
form: a vertex is given up for another only where that costs no more.
"""

from __future__ import annotations

from collections.abc import Mapping

from pico.staging.feedback.digraph import Digraph, strong_components

Weights = Mapping[int, float]


def reduce(graph: Digraph, weights: Weights, *, thorough: bool = True) -> list[int]:
    """Shrink `graph` in place to its kernel and return the vertices that some cheapest set takes besides.

    `thorough`: with PIE, CORE and DOME, not only degrees and self-loops.
    """
    taken = _by_degree(graph, weights, list(graph.succ))
    while thorough and graph.succ:
        chosen, touched = _one_round(graph, weights)
        if not touched:
            return taken
        taken += chosen
        taken += _by_degree(graph, weights, [v for v in touched if v in graph.succ])
    return taken


def _one_round(graph: Digraph, weights: Weights) -> tuple[list[int], list[int]]:
    """Apply the first of the costlier reductions that finds something: vertices taken, vertices whose arcs changed."""
    useless = _cut_between_components(graph) or _cut_dominated(graph)
    if useless:
        return [], sorted({w for arc in useless for w in arc})
    clique = _core(graph, weights)
    touched = sorted({w for v in clique for w in graph.succ[v] | graph.pred[v]})
    for v in clique:
        graph.remove(v)
    return clique, touched


def _by_degree(graph: Digraph, weights: Weights, queue: list[int]) -> list[int]:
    taken = []
    queued = set(queue)
    queue = sorted(queue, reverse=True)
    while queue:
        v = queue.pop()
        queued.discard(v)
        if v not in graph.succ:
            continue
        before, after = graph.pred[v], graph.succ[v]
        near = (before | after) - {v}
        if v in after:
            taken.append(v)
            graph.remove(v)
        elif not before or not after:
            graph.remove(v)
        elif _gives_way(before, weights, v) or _gives_way(after, weights, v):
            graph.bypass(v)
        else:
            continue
        fresh = sorted((w for w in near if w not in queued), reverse=True)
        queue += fresh
        queued.update(fresh)
    return taken


def _gives_way(side: set[int], weights: Weights, v: int) -> bool:
    """Whether every cycle through `v` passes one other vertex that costs no more."""
    return len(side) == 1 and weights[next(iter(side))] <= weights[v]


def _cut_between_components(graph: Digraph) -> list[tuple[int, int]]:
    """Cut the arcs whose cycles all use both directions of some pair: they connect strong components of the graph
    without 2-cycles."""
    single = {v: graph.succ[v] - graph.both_ways(v) for v in graph.succ}
    part = {v: n for n, component in enumerate(strong_components(single)) for v in component}
    arcs = [(u, v) for u in single for v in single[u] if part[u] != part[v]]
    for u, v in arcs:
        graph.unlink(u, v)
    return arcs


def _cut_dominated(graph: Digraph) -> list[tuple[int, int]]:
    """Cut the arcs without which each cycle that has no chord is left."""
    arcs = []
    for u in graph.succ:
        for v in sorted(graph.succ[u] - graph.pred[u]):
            single_in = graph.pred[u] - graph.succ[u]
            if single_in <= graph.pred[v] or graph.succ[v] - graph.pred[v] <= graph.succ[u]:
                graph.unlink(u, v)
                arcs.append((u, v))
    return arcs


def _core(graph: Digraph, weights: Weights) -> list[int]:
    """Return the neighbors of a vertex that forms with them, and only them, a clique of 2-cycles, and costs most."""
    for v in graph.succ:
        near = graph.succ[v]
        if near != graph.pred[v] or any(weights[w] > weights[v] for w in near):
            continue
        if all(near - {w} <= graph.both_ways(w) for w in near):
            return sorted(near)
    return []
