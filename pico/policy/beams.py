"""Which laser beams may be open while an operation runs, by what must be done before it and after it."""

from __future__ import annotations

from collections.abc import Sequence
from graphlib import TopologicalSorter

from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.planning.checks.beams import shutter_of

CLOSED = "closed"


def open_beams(
    setup: Setup, operations: Sequence[Operation], seen: Observation, lasers: Sequence[str]
) -> dict[str, list[str]]:
    """Return for each operation, by id, the lasers that nothing is known to have closed while it runs.

    A beam is closed where its shutter was read back closed, or an operation that must end before closes it, and each
    operation that opens it ends before that one, or waits for this one. A laser that is read back as off is closed, as
    long as no operation turns it on.
    """
    before = _ancestors(operations)
    numbers = {op.id: n for n, op in enumerate(operations)}
    found: dict[str, list[str]] = {op.id: [] for op in operations}
    for laser in lasers:
        if _dark(operations, seen, laser):
            continue
        shutter = _shutter(setup, operations, seen, laser)
        sets = [op for op in operations if shutter and _sets(op, shutter, "shutter")]
        closing = [numbers[op.id] for op in sets if op.arguments.get("to") == CLOSED]
        opening = [numbers[op.id] for op in sets if op.arguments.get("to") != CLOSED]
        shut = shutter is not None and _read(seen, shutter, "shutter") == CLOSED
        for op in operations:
            n = numbers[op.id]
            if not _closed(n, before, closing, opening, shut):
                found[op.id].append(laser)
    return found


def _closed(n: int, before: Sequence[int], closing: Sequence[int], opening: Sequence[int], shut: bool) -> bool:
    done = [c for c in closing if before[n] >> c & 1]
    waiting = [o for o in opening if not before[o] >> n & 1]  # those that need not wait for this one
    if not done:
        return shut and not waiting
    return all(any(before[c] >> o & 1 for c in done) for o in waiting)


def _ancestors(operations: Sequence[Operation]) -> list[int]:
    """Return for each operation those that must end before it, as bits."""
    numbers = {op.id: n for n, op in enumerate(operations)}
    after = {n: [numbers[name] for name in op.after if name in numbers] for n, op in enumerate(operations)}
    found = [0] * len(operations)
    for n in TopologicalSorter(after).static_order():
        for earlier in after[n]:
            found[n] |= found[earlier] | 1 << earlier
    return found


def _shutter(setup: Setup, operations: Sequence[Operation], seen: Observation, laser: str) -> str | None:
    """Return the component whose shutter closes a laser: itself, or the first thing in its beam."""
    if "shutter" in setup.type_of(laser).tunables:
        return laser
    return shutter_of(setup, seen, operations, laser)


def _dark(operations: Sequence[Operation], seen: Observation, laser: str) -> bool:
    lit = any(_sets(op, laser, "emission") and op.arguments.get("to") is not False for op in operations)
    return _read(seen, laser, "emission") is False and not lit


def _sets(op: Operation, component: str, tunable: str) -> bool:
    return op.primitive == "set" and op.component == component and op.arguments.get("tunable") == tunable


def _read(seen: Observation, component: str, tunable: str) -> object:
    part = seen.components.get(component)
    live = part.values.get(tunable) if part else None
    return live.value if live and live.status == "known" else None
