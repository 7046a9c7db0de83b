"""When each operation starts: the arms take theirs in order, motors and set-points find the earliest gap beside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pico.model.operation import Operation
from pico.planning.passes.draft import Draft

Span = tuple[float, float]
Waits = Sequence[Sequence[int]]
"""For each operation by its place in the list those that it waits for, in order of the list."""


def scheduled(draft: Draft) -> Draft:
    """Return the plan with its operations in time, as long as they take on the bench. What arms need at least is known
    of paths and speeds alone."""
    operations = draft.timed(draft.operations)
    measured = any(op.nominal is not None for op in operations)
    return replace(draft, operations=schedule(operations), bound=None if measured else draft.bound)


def schedule(operations: Sequence[Operation]) -> tuple[Operation, ...]:
    """Return the operations with start times and ids `op1`, `op2`, ... sorted by start.

    List scheduling: an operation starts when all in `after` are done and each of its resources is free for as long as
    it takes. Operations of robots and people keep their order; the others come after them, the longest chain first.
    """
    waits = _waits(operations)
    busy: dict[str, list[Span]] = {}
    ends: dict[int, float] = {}
    starts: dict[int, float] = {}
    for n in _priorities(operations, waits):
        operation = operations[n]
        ready = max((ends[e] for e in waits[n]), default=0.0)
        spans = sorted(s for r in operation.resources for s in busy.get(r, ()))
        if operation.robot:  # an arm takes its operations in order: no gap before what it already has
            ready = max([ready, *(end for _, end in busy.get(operation.robot, ()))])
        starts[n] = _gap(spans, ready, operation.seconds)
        ends[n] = starts[n] + operation.seconds
        for resource in operation.resources:
            busy.setdefault(resource, []).append((starts[n], ends[n]))
    return _numbered(operations, waits, starts)


def _waits(operations: Sequence[Operation]) -> Waits:
    at = {op.id: n for n, op in enumerate(operations)}
    return [sorted(at[e] for e in op.after) for op in operations]


def _priorities(operations: Sequence[Operation], waits: Waits) -> list[int]:
    """Return the order in which operations are given their time; what one waits for comes before it."""
    turns = _in_turn(operations, waits)
    rest = sorted(set(range(len(operations))) - set(turns))
    tails = {n: operations[n].seconds for n in rest}
    for n in reversed(rest):
        for e in waits[n]:
            if e in tails:
                tails[e] = max(tails[e], operations[e].seconds + tails[n])
    ordered = sorted(rest, key=lambda n: (bool(waits[n]), -tails[n], n))
    return turns + _each_after(waits, ordered)


def _each_after(waits: Waits, ordered: Sequence[int]) -> list[int]:
    """Return operations in an order, but none before what it waits for among them."""
    found: dict[int, None] = {}
    wanted = set(ordered)

    def put(n: int) -> None:
        for e in waits[n]:
            if e in wanted and e not in found:
                put(e)
        found.setdefault(n)

    for n in ordered:
        put(n)
    return list(found)


def _in_turn(operations: Sequence[Operation], waits: Waits) -> list[int]:
    """Return the operations of robots and people as they are listed, each after what it waits for, a shutter, say."""
    order: dict[int, None] = {}
    left = [n for n, o in enumerate(operations) if o.robot or o.kind.by_hand]
    left = [*_awaited(waits, left), *left]
    while left:
        n = next(n for n in left if all(e in order for e in waits[n]))
        order[n] = None
        left.remove(n)
    return list(order)


def _awaited(waits: Waits, turns: Sequence[int]) -> list[int]:
    """Return what robots and people wait for besides one another, directly or not."""
    found: set[int] = set()
    todo = list(turns)
    while todo:
        new = set(waits[todo.pop()]) - found - set(turns)
        found |= new
        todo += new
    return sorted(found)


def _gap(spans: Sequence[Span], ready: float, seconds: float) -> float:
    """Return the earliest start, from `ready` on, of a gap of so many seconds between busy spans."""
    start = ready
    for begin, end in spans:
        if begin >= start + seconds - 1e-9 and begin > start - 1e-9:
            return start
        start = max(start, end)
    return start


def _numbered(operations: Sequence[Operation], waits: Waits, starts: dict[int, float]) -> tuple[Operation, ...]:
    order = sorted(range(len(operations)), key=lambda n: (round(starts[n], 6), n))
    place = {n: k for k, n in enumerate(order)}
    return tuple(
        replace(
            operations[n],
            id=f"op{place[n] + 1}",
            start=round(starts[n], 6),
            seconds=round(operations[n].seconds, 6),
            after=tuple(f"op{k + 1}" for k in sorted(place[e] for e in waits[n])),
        )
        for n in order
    )


def makespan(operations: Sequence[Operation]) -> float:
    """Return when the last operation ends [s]."""
    return round(max((o.start + o.seconds for o in operations), default=0.0), 6)


def least_makespan(operations: Sequence[Operation], arms: float | None) -> float | None:
    """Return a time before which no schedule of these operations ends [s]: what the arms need in any order, people
    while the arms stand still, and what comes before all of them and after, a shutter, say; or what one component's
    motors and set-points need one after the other. None where the arms do not tell."""
    if arms is None or not operations:
        return None
    people = sum(o.seconds for o in operations if o.kind.by_hand)
    chains: dict[str, float] = {}
    for o in operations:
        if o.kind.drives:
            chains[o.component] = chains.get(o.component, 0.0) + o.seconds
    around = sum(_around(operations)) if arms else 0.0
    return round(min(max(arms + people + around, *chains.values(), 0.0), makespan(operations)), 6)


def _around(operations: Sequence[Operation]) -> tuple[float, float]:
    """Return how long the longest operation takes that all of the robots' wait for, and the longest that waits for all
    of them [s]. `operations` come after what they wait for."""
    earlier: dict[str, frozenset[str]] = {}
    for o in operations:
        earlier[o.id] = frozenset(o.after).union(*(earlier[e] for e in o.after))
    robots = {o.id for o in operations if o.robot}
    first = frozenset.intersection(*(earlier[i] for i in robots)) if robots else frozenset[str]()
    others = [o for o in operations if not o.robot and robots]
    return (
        max((o.seconds for o in others if o.id in first), default=0.0),
        max((o.seconds for o in others if robots <= earlier[o.id]), default=0.0),
    )
