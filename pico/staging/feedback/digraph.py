"""Directed graphs over integers: strongly connected components, shortest cycles, topological order."""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Collection, Iterator, Mapping

Successors = Mapping[int, Collection[int]]
"""The out-neighbors of each vertex."""


def strong_components(succ: Successors) -> list[list[int]]:
    """Return the strongly connected components, sinks first (Tarjan, without recursion)."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    on_stack: set[int] = set()
    found: list[list[int]] = []
    for root in succ:
        if root in index:
            continue
        work: list[tuple[int, Iterator[int]]] = [(root, iter(succ[root]))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            v, children = work[-1]
            for w in children:
                if w not in index:
                    index[w] = low[w] = len(index)
                    stack.append(w)
                    on_stack.add(w)
                    work.append((w, iter(succ[w])))
                    break
                if w in on_stack:
                    low[v] = min(low[v], index[w])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[v])
                if low[v] == index[v]:
                    at = len(stack) - 1
                    while stack[at] != v:
                        at -= 1
                    found.append(stack[at:])
                    del stack[at:]
                    on_stack.difference_update(found[-1])
    return found


def cyclic_components(succ: Successors) -> list[list[int]]:
    """Return the components that hold a cycle, each sorted, in the order of their least vertices."""
    return sorted(sorted(c) for c in strong_components(succ) if len(c) > 1 or c[0] in succ[c[0]])


def shortest_cycle(succ: Successors, start: int, alive: Collection[int]) -> list[int] | None:
    """Return a cycle with the fewest vertices through `start` within `alive`, or None; ties by least vertices."""
    if start in succ[start]:
        return [start]
    parent = {start: start}
    queue = deque([start])
    while queue:
        v = queue.popleft()
        for w in sorted(succ[v]):
            if w == start:
                return _trace(parent, v)
            if w in alive and w not in parent:
                parent[w] = v
                queue.append(w)
    return None


def _trace(parent: Mapping[int, int], v: int) -> list[int]:
    path = [v]
    while parent[v] != v:
        v = parent[v]
        path.append(v)
    return path[::-1]


def some_cycle(succ: Successors) -> list[int] | None:
    """Return a cycle with the fewest vertices of the graph, or None where it has none."""
    best: list[int] | None = None
    for part in cyclic_components(succ):
        alive = set(part)
        for v in part:
            cycle = shortest_cycle(succ, v, alive)
            if cycle and (best is None or len(cycle) < len(best)):
                best = cycle
    return best


def topological_order(succ: Successors) -> list[int]:
    """Return the vertices, each before its successors, least first among those free to come.

    Vertices on cycles, and what comes after them, are left out.
    """
    waits = dict.fromkeys(succ, 0)
    for v in succ:
        for w in succ[v]:
            waits[w] += 1
    heap = [v for v, n in waits.items() if n == 0]
    heapq.heapify(heap)
    order = []
    while heap:
        v = heapq.heappop(heap)
        order.append(v)
        for w in succ[v]:
            waits[w] -= 1
            if waits[w] == 0:
                heapq.heappush(heap, w)
    return order
