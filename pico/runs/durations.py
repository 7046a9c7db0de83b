"""How long operations take on a bench, by what earlier ones took there."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from statistics import median

from pico.model.operation import Operation, operation_from_json
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.trace.learned import work
from pico.runs.journal import JournalRecord

LATEST = 10
"""So many operations of a kind count, the latest."""


@record
class Duration:
    """What operations of a kind take beside what paths and speeds alone say: `factor` times that, and `more` [s]."""

    factor: float = 1.0
    more: float = 0.0


def measured_durations(setup: Setup, records: Iterable[JournalRecord]) -> Mapping[str, Duration]:
    """Return what operations of each kind (see `pico.model.trace.learned.work`) took on a bench, by its journal.

    Arms take a multiple of what their path says, for their speed is limited; the rest takes so much longer, for a
    device has to answer. Both are medians of the latest operations that succeeded, so that one that was tried again
    does not count.
    """
    begun: dict[str, Operation] = {}
    took: dict[str, list[tuple[float, float]]] = defaultdict(list)
    arms = set[str]()
    for one in records:
        if one.kind == "intent":
            begun[one.key] = operation_from_json(one.data)
        elif one.kind == "done" and (op := begun.get(one.key)) is not None:
            kind, plain = _work(setup, op), op.seconds if op.nominal is None else op.nominal
            seconds = float(one.data.get("seconds") or 0.0)
            if kind is None or plain <= 0 or seconds <= 0:
                continue
            took[kind].append((plain, seconds))
            arms |= {kind} if op.robot else set()
    return {
        kind: _ratio(pairs[-LATEST:]) if kind in arms else _overhead(pairs[-LATEST:]) for kind, pairs in took.items()
    }


def as_measured(
    setup: Setup, operations: Sequence[Operation], durations: Mapping[str, Duration]
) -> tuple[Operation, ...]:
    """Return operations with the seconds that they take on a bench, each with what paths and speeds alone say as
    `nominal`; those of a kind that never was done there stay as they are."""
    found = []
    for op in operations:
        known = durations.get(_work(setup, op) or "")
        if known is not None and op.nominal is None and op.seconds > 0:
            op = replace(op, nominal=op.seconds, seconds=round(op.seconds * known.factor + known.more, 6))
        found.append(op)
    return tuple(found)


def _work(setup: Setup, op: Operation) -> str | None:
    if op.kind.by_hand or (op.component not in setup.lab.inventory and op.robot not in setup.lab.robots):
        return None
    return work(setup, op.primitive, op.component, op.robot, op.arguments)


def _ratio(pairs: Sequence[tuple[float, float]]) -> Duration:
    return Duration(factor=median(seconds / plain for plain, seconds in pairs))


def _overhead(pairs: Sequence[tuple[float, float]]) -> Duration:
    return Duration(more=max(0.0, median(seconds - plain for plain, seconds in pairs)))
