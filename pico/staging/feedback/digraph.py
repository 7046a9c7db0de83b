"""Directed graphs: strongly connected components, and shortest cycles with ties by least vertices."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence
from typing import TypeVar

V = TypeVar("V", int, str)
Successors = Mapping[V, Collection[V]]
"""The out-neighbors of each vertex."""


def strong_components(succ: Successors[V]) -> list[list[V]]:
    """Return the strongly connected components."""
    import networkx as nx

    return [list(c) for c in nx.strongly_connected_components(nx.DiGraph(succ))]


def cyclic_components(succ: Successors[V]) -> list[list[V]]:
    """Return the components that hold a cycle, each sorted, in the order of their least vertices."""
    return sorted(sorted(c) for c in strong_components(succ) if len(c) > 1 or c[0] in succ[c[0]])


def ordered(succ: Successors[V]) -> dict[V, list[V]]:
    """Return the graph with its out-neighbors sorted."""
    return {v: sorted(heads) for v, heads in succ.items()}


def shortest_cycle(succ: Mapping[V, Sequence[V]], start: V, alive: Collection[V]) -> list[V] | None:
    """Return a cycle with the fewest vertices through `start` within `alive`, or None; ties by which neighbor comes
    first."""
    if start in succ[start]:
        return [start]
    parent = {start: start}
    queue = deque([start])
    while queue:
        v = queue.popleft()
        for w in succ[v]:
            if w == start:
                return _trace(parent, v)
            if w in alive and w not in parent:
                parent[w] = v
                queue.append(w)
    return None


def _trace(parent: Mapping[V, V], v: V) -> list[V]:
    path = [v]
    while parent[v] != v:
        v = parent[v]
        path.append(v)
    return path[::-1]


def some_cycle(succ: Successors[V]) -> list[V] | None:
    """Return a cycle with the fewest vertices of the graph, or None where it has none."""
    best: list[V] | None = None
    sorted_once = ordered(succ)
    for part in cyclic_components(succ):
        alive = set(part)
        for v in part:
            cycle = shortest_cycle(sorted_once, v, alive)
            if cycle and (best is None or len(cycle) < len(best)):
                best = cycle
    return best
