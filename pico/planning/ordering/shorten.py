"""Leaves out moves that an order of moves can do without: what a greedy search put down too early."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.search import OrderedMove


def shortened(table: Conflicts, steps: Sequence[OrderedMove]) -> tuple[OrderedMove, ...]:
    """Return the steps without those that can be merged with the next of the same component, or left out where they
    bring it back to where it was, or from right to right, as long as every remaining move stays possible."""
    best = tuple(steps)
    while True:
        better = next((b for b in (valid(table, c) for c in _shorter(table, best)) if b is not None), None)
        if better is None:
            return best
        best = better


def _shorter(table: Conflicts, steps: tuple[OrderedMove, ...]) -> Iterator[tuple[OrderedMove, ...]]:
    """Yield the steps with two consecutive moves of one component replaced by one, early or late, or by none."""
    for first, step in enumerate(steps):
        later = next((k for k, other in enumerate(steps) if k > first and other.mover == step.mover), None)
        mover = table.movers[step.mover]
        if later is None:
            if mover.right and step.start == 0 and step.goal in mover.goals:
                yield (*steps[:first], *steps[first + 1 :])
            continue
        before, between, after = steps[:first], steps[first + 1 : later], steps[later + 1 :]
        end = steps[later].goal
        if end == step.start or (mover.right and step.start == 0 and end in mover.goals):
            yield (*before, *between, *after)
        if end != step.start:
            merged = OrderedMove(step.mover, step.start, end, step.hold, 0)
            yield (*before, merged, *between, *after)
            yield (*before, *between, merged, *after)


def valid(table: Conflicts, steps: Sequence[OrderedMove]) -> tuple[OrderedMove, ...] | None:
    """Return the steps with holds and masks that are possible one after the other, or None where one is not."""
    taken = table.starts
    out = []
    for step in steps:
        start = table.bit(step.mover, step.start)
        way = table.way(step.mover, step.start, step.goal, taken) if taken & start else None
        if way is None:
            return None
        out.append(OrderedMove(step.mover, step.start, step.goal, way.hold, way.mask))
        taken ^= start ^ table.bit(step.mover, step.goal)
    return tuple(out)
