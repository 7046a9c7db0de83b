"""Whether one unit can flow between two nodes of a sparse network, and the cut that prevents it."""

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
        while True:
            back = self._search(source, sink, banned, room)
            if sink not in back:
                return sum(1 << node for node in back)
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

    def _search(self, source: int, sink: int, banned: int, room: abc.Sequence[float]) -> dict[int, int]:
        """Return for each node that can still be reached the arc that a shortest path enters it by."""
        back, queue, head, out = {source: -1}, [source], self._head, self._out
        for reached in queue:  # it grows meanwhile
            for e in out[reached]:
                node = head[e]
                if room[e] > TINY and node not in back and not banned >> node & 1:
                    back[node] = e
                    if node == sink:
                        return back
                    queue.append(node)
        return back
