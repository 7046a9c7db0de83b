"""A run done again: its operations one after the other on the bench as it is now, as one recorded run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from pico.bench.bench import Bench
from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.measurement import Measurement, incomparable, measurement_from_json
from pico.model.plan import Plan, Target
from pico.model.record import record
from pico.model.trace.report import RunReport
from pico.runs.operations import OperationRun, operations
from pico.scripting.outcome import require_done, require_possible
from pico.scripting.recording import Recording

if TYPE_CHECKING:
    from pico.runs.document import RecordedRun

IN_PASSING = ("interlock", "parked", "held")
"""Why operations were done that plans add by themselves, and add again."""


@record
class Compared:
    """A number that was measured `then` and `now`, with what the two differ by in combined standard deviations (None
    where nobody tells them), and `why` they must not be compared (empty where they may)."""

    address: str
    unit: str
    then: float
    now: float
    sigmas: float | None = None
    why: str = ""


@record
class Replayed:
    """What became of a run `of` another one: its report, and the numbers of both."""

    of: str
    report: RunReport
    compared: tuple[Compared, ...] = ()


def steps(run: RecordedRun) -> tuple[OperationRun, ...]:
    """Return the operations of a run that are to be done again, in their order; raises PicoError for one that has no
    operation to do again, or some that only a search or a person did."""
    found = [op for op in operations(run.trace) if op.outcome == "done" and op.reason not in IN_PASSING]
    if wrong := [_never(op) for op in found if op.primitive not in _AGAIN]:
        raise PicoError(wrong)
    if not found:
        raise PicoError(error("nothing", f"run {run.document.id} did nothing that could be done again"))
    return tuple(found)


def replay(bench: Bench, run: RecordedRun, show: Callable[[OperationRun], None] = lambda _: None) -> Replayed:
    """Do again what a run did, and return what became of that; `show` hears of each operation before it is done.

    Raises PicoError before anything moves for what can't be done again, and where something of it fails.
    """
    again, then, now = steps(run), list[Measurement](), list[Measurement]()
    goal = Target(title=f"replay of {run.document.id}", cause="recording", of=run.document.id)
    with Recording(bench, f"replay of {run.document.id}", goal) as recording:
        for op in again:
            show(op)
            plan = require_possible(_AGAIN[op.primitive](bench, op))
            report = require_done(bench.moves.apply(plan))
            if op.primitive == "measure":
                then.append(measurement_from_json(op.data["measurement"]))
                now.append(report.measurements[op.address])
    pairs = zip(then, now, strict=True)
    compared = tuple(one for a, b in pairs for one in _compared(a, b))
    return Replayed(of=run.document.id, report=recording.report, compared=compared)


def _set(bench: Bench, op: OperationRun) -> Plan:
    return bench.plans.setting({op.address: op.arguments["to"]})


def _move(bench: Bench, op: OperationRun) -> Plan:
    to = op.arguments["to"]
    return bench.plans.moving({op.component: to.get("slot") or to["pose"]})


def _measure(bench: Bench, op: OperationRun) -> Plan:
    return bench.plans.measuring([(op.component, str(op.arguments["measurable"]))])


def _by_itself(bench: Bench, op: OperationRun) -> Plan:
    tunable = op.arguments.get("tunable")
    return bench.plans.single(op.component, op.primitive, {"tunable": str(tunable)} if tunable else {})


_AGAIN: dict[str, Callable[[Bench, OperationRun], Plan]] = {
    "set": _set, "move": _move, "stow": _move, "measure": _measure, "home": _by_itself, "auto_range": _by_itself,
}  # fmt: skip


def _never(op: OperationRun) -> Diagnostic:
    hint = "`pico optimize` seeks a goal anew; `pico apply` brings back the state that it led to"
    return error("replay", f"{op.primitive} of {op.address} ({op.id}) can't be done again as it was", hint=hint)


def _compared(then: Measurement, now: Measurement) -> Iterator[Compared]:
    why = "; ".join(incomparable(then, now))
    for name, (value, sigma, unit) in then.numbers.items():
        if name not in now.numbers:
            continue
        other, other_sigma, _ = now.numbers[name]
        both = math.hypot(sigma, other_sigma) if sigma and other_sigma else 0.0
        yield Compared(
            address=f"{then.address}.{name}" if name else then.address, unit=unit, then=value, now=other,
            sigmas=abs(other - value) / both if both else None, why=why,
        )  # fmt: skip
