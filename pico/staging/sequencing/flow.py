"""Whether one unit can flow between two nodes of a sparse network, and the cut that prevents it.

Not by networkx: with its flows the order of 40 moves took 0.8 s instead of 0.3 (benchmarks/travel.py --sizes 40).
"""

from __future__ import annotations

from collections import abc

Arc = tuple[int, int, float]
"""Tail, head and capacity."""

TINY = 1e-9
"""Less room than this is none."""


class Network:
    """Arcs with capacities; each has its reverse beside it, so that arc e runs against arc e ^ 1."""

    def __init__(self, size: int, arcs: abc.Iterable[Arc]) -> None:
        self._out: list[list[int]] = [[] for _ in range(size)]
        self._head: list[int] = []
        self._capacity: list[float] = []
        for tail, head, capacity in arcs:
            self._out[tail].append(len(self._head))
            self._out[head].append(len(self._head) + 1)
            self._head += [head, tail]
            self._capacity += [capacity, 0.0]

    def cut(self, source: int, sink: int, banned: int, enough: float) -> int | None:
        """Return the source's side of a smallest cut, or None where at least `enough` can flow; `banned` nodes are left
        out. Sides and nodes are bits."""
        room, flow = self._capacity.copy(), 0.0
        shut = bytearray(banned >> node & 1 for node in range(len(self._out)))
        while True:
            reached, back = self._search(source, sink, shut.copy(), room)
            if reached[-1] != sink:
                return sum(1 << node for node in reached)
            path, node = list[int](), sink
            while node != source:
                path.append(back[node])
                node = self._head[back[node] ^ 1]
            push = min(room[e] for e in path)
            for e in path:
                room[e] -= push
                room[e ^ 1] += push
            flow += push
            if flow >= enough:
                return None

    def _search(
        self, source: int, sink: int, closed: bytearray, room: abc.Sequence[float]
    ) -> tuple[list[int], list[int]]:  # fmt: skip
        """Return the nodes that can still be reached, as far as the sink, and for each the arc that a shortest path
        enters it by. `closed`: one byte a node, set where it is left out; the search sets those it has reached."""
        queue, back, head, out = [source], [-1] * len(closed), self._head, self._out
        closed[source] = 1
        for node in queue:  # it grows meanwhile
            for e in out[node]:
                if room[e] > TINY and not closed[head[e]]:
                    to = head[e]
                    closed[to] = 1
                    back[to] = e
                    queue.append(to)
                    if to == sink:
                        return queue, back
        return queue, back
