"""Two runs side by side: where they ended, how long each operation took, and what was otherwise about them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import Any

from pico.model.diff import Change, show_value
from pico.model.measurement import Measurement, incomparable, measurement_from_json
from pico.model.record import as_json, record
from pico.model.setup import Setup
from pico.model.trace.run import Run
from pico.runs.document import RecordedRun
from pico.runs.operations import OperationRun, operations
from pico.runs.states import changes


@record
class Pair:
    """One operation in both runs, the last attempt of each; None where the other alone has it. `to`: the value set."""

    primitive: str
    address: str
    to: str = ""
    a: OperationRun | None = None
    b: OperationRun | None = None


@record
class Differing:
    """Something about two runs that is not the same, by name; None where one does not say it."""

    name: str
    a: Any = None
    b: Any = None


@record
class MeasuredTwice:
    """A measurable that was measured in both runs, and why these must not be compared, where they must not."""

    address: str
    a: Measurement
    b: Measurement
    incomparable: tuple[str, ...] = ()


@record
class Comparison:
    """Two runs. `same`: they led to the same state. `changes`: from where the first ended to where the second did, as
    observed, None where one of them was not observed; `differing`: outcome, goal, evidence, calibration, versions...
    `measured`: what was measured in both."""

    a: Run
    b: Run
    same: bool
    changes: tuple[Change, ...] | None = None
    operations: tuple[Pair, ...] = ()
    differing: tuple[Differing, ...] = ()
    measured: tuple[MeasuredTwice, ...] = ()


def _taken(run: RecordedRun) -> dict[str, Measurement]:
    """Return the last measurement of each measurable in a run, by address; what is odd is passed over."""
    found = {}
    for event in run.measurements:
        if event.kind == "measurement":
            with suppress(ValueError):
                taken = measurement_from_json(event.data)
                found[taken.address] = taken
    return found


def _both_measured(a: Mapping[str, Measurement], b: Mapping[str, Measurement]) -> Iterator[MeasuredTwice]:
    for address in sorted(a.keys() & b.keys()):
        one, other = a[address], b[address]
        yield MeasuredTwice(address=address, a=one, b=other, incomparable=incomparable(one, other))


def compare_runs(setup: Setup, a: RecordedRun, b: RecordedRun) -> Comparison:
    """Return two runs side by side; `setup`: the bench as it is now, whose tolerances count."""
    found = None
    if _looked(a) and _looked(b) and a.after and b.after:  # else somebody did not look afterwards
        found = changes(setup, a.after, b.after, a.after.components.keys() | b.after.components.keys())
    return Comparison(
        a=a.document,
        b=b.document,
        same=a.document.state_after == b.document.state_after,
        changes=found,
        operations=tuple(_pairs(operations(a.trace), operations(b.trace))),
        differing=tuple(_differing(_facts(a.document), _facts(b.document))),
        measured=tuple(_both_measured(_taken(a), _taken(b))),
    )


def _looked(run: RecordedRun) -> bool:
    return any(event.kind == "observation" for event in run.measurements)


def _pairs(a: Iterable[OperationRun], b: Iterable[OperationRun]) -> Iterator[Pair]:
    """Yield the operations that both have, matched by what they do, then those of one alone."""
    first, second = _by_deed(a), _by_deed(b)
    for key in dict.fromkeys((*first, *second)):
        yield Pair(primitive=key[0], address=key[1], to=key[2], a=first.get(key), b=second.get(key))


def _by_deed(found: Iterable[OperationRun]) -> dict[tuple[str, str, str, int], OperationRun]:
    """Return the last attempt of each operation by primitive, address, value to set, and the how-manieth such it is."""
    last: dict[str, OperationRun] = {}
    for op in found:
        if op.id not in last or op.attempt > last[op.id].attempt:
            last[op.id] = op
    counted: Counter[tuple[str, str, str]] = Counter()
    keyed = {}
    for op in last.values():
        deed = (op.primitive, op.address, show_value(op.arguments.get("to")) if op.primitive == "set" else "")
        counted[deed] += 1
        keyed[*deed, counted[deed]] = op
    return keyed


def _facts(run: Run) -> dict[str, Any]:
    """Return what is compared of two documents besides states and operations."""
    facts: dict[str, Any] = {
        "outcome": run.outcome, "goal": run.goal, "cause": run.cause.kind, "evidence": run.evidence, "seed": run.seed,
        "seconds": round(run.seconds, 3), "operator": run.operator, "parent": run.parent, "plan": run.plan,
        "state before": run.state_before, "lab": run.lab.digest, "calibration": run.calibration,
    }  # fmt: skip
    facts |= {kind: number for kind, number in run.tally.items() if kind != "done" or number}
    facts |= {f"environment {name}": value for name, value in run.environment.items()}
    facts |= {f"version of {name}": value for name, value in run.versions.items()}
    return facts | {f"expectation `{e.that}`": as_json(e.holds) for e in run.expectations}


def _differing(a: Mapping[str, Any], b: Mapping[str, Any]) -> Iterator[Differing]:
    for name in dict.fromkeys((*a, *b)):
        if a.get(name) != b.get(name):
            yield Differing(name=name, a=a.get(name), b=b.get(name))
