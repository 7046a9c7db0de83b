"""One run of a journal as its document, its trace and what was measured."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any

from pico.diagnostics import Diagnostic
from pico.model.measurement import measurement_from_json
from pico.model.operation import address_of
from pico.model.plan import LabRef
from pico.model.pose import Pose
from pico.model.record import digest, record
from pico.model.setup import Setup
from pico.model.shown.html import table
from pico.model.state import LabState, state_from_json
from pico.model.trace.expectation import Expected
from pico.model.trace.run import STRENGTH, Cause, Run, Seen, TraceEvent
from pico.runs.journal import JournalRecord, RunRecord
from pico.runs.memory import Memory
from pico.runs.operations import OperationRun, operations
from pico.runs.states import changes, digest_of, state_left, state_seen, states_along, touched
from pico.runs.trace import artifacts, busy, counted, measured, trace_events, unmet

ASKED = ("asked", "parked", "interlock", "held")


@record
class RecordedRun:
    """A run with what lies beside its document.

    `before`, `after`: the states that were observed at its ends, None where that is not known. `holder`: who had the
    bench, as far as its journal is here. `stored`: where artifacts lie that are here, seen from the lab's folder, and
    `missing`: those that are not, both by SHA-256. `diagnostics`: what is wrong with the files.
    """

    document: Run
    before: LabState | None = None
    after: LabState | None = None
    trace: tuple[TraceEvent, ...] = ()
    measurements: tuple[TraceEvent, ...] = ()
    holder: str = ""
    stored: Mapping[str, str] = field(default_factory=dict)
    missing: frozenset[str] = frozenset()
    diagnostics: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        d = self.document
        return f"<run {d.id}: {d.goal}, {d.outcome}, {d.tally.get('done', 0)} done in {d.seconds:.1f} s, {d.evidence}>"

    def _repr_html_(self) -> str:
        rows = [
            (f"{op.start:.1f}" if op.start is not None else "", op.primitive, op.address, _led_to(op), op.outcome)
            for op in operations(self.trace)
        ]
        return table(repr(self)[1:-1], ("s", "operation", "of", "", "ended"), rows)


def _led_to(op: OperationRun) -> str:
    """Return in a few words what an operation was to lead to, or what it measured."""
    found = op.data.get("measurement")
    if isinstance(found, Mapping):
        return measurement_from_json(found).said
    to = op.arguments.get("to")
    return str(to.get("slot") or Pose(**to["pose"])) if isinstance(to, Mapping) else "" if to is None else f"→ {to}"


def recorded(setup: Setup, memory: Memory, run: RunRecord, part: int = 0) -> RecordedRun | None:
    """Return a run that a bench remembers; `setup`: the bench as it is now. None where that did not keep its plan, or
    nothing began.

    `part`: only what came since it was taken up again for the n-th time, where a commit has what was before that.
    """
    text, records = memory.document(run.run), memory.records(run=run.run)
    own = [r for r in records if _resumption(r) >= part]
    if text is None or not touched(own):
        return None
    plan = json.loads(text)  # plain data: it may be of an older PICO
    starts, seen = memory.about(run.run)
    earlier = [r for r in records if _resumption(r) < part]
    before = state_left(setup, state_from_json(plan["lab"]["name"], plan["base"]["state"]), earlier)
    after = state_seen(setup, seen["components"]) if seen else state_left(setup, before, own)
    doers = [str(start.get("operator", "")) for start in starts] or [""]
    trace = trace_events(
        own, states_along(setup, before, own), lambda r: doers[min(_resumption(r), len(doers) - 1)]
    )  # fmt: skip
    observed = digest_of(setup, after)
    about = starts[min(part, len(starts) - 1)] if starts else {}
    document = Run(
        id=f"{run.run}-r{part}" if part else run.run,
        number=run.number,
        lab=LabRef(**plan["lab"]),
        parent=plan["base"].get("commit"),
        state_before=digest_of(setup, before),
        state_after=_reached(plan, seen) or observed,
        observed=Seen(at=seen["at"] if seen else own[-1].at, state=observed, looked=seen is not None),
        plan=plan["digest"],
        goal=_goal(plan),
        goal_commit=plan["target"].get("commit"),
        cause=Cause(kind="resume", of=run.run) if part else Cause(**about.get("cause", {})),
        evidence=weakest(starts, plan),
        seed=about.get("seed"),
        operator=about.get("operator", ""),
        calibration=plan.get("calibration"),
        environment=about.get("environment", {}),
        versions=about.get("versions", {}),
        started_at=own[0].at if part else run.started_at,
        ended_at=run.finished_at or own[-1].at,
        outcome=run.outcome or "killed",
        seconds=busy(own),
        tally=counted(own, int((run.tally or {}).get("skipped", 0))),
        resumed=run.resumed,
        expectations=tuple(Expected(**e) for e in seen["expectations"]) if seen else (),
        changes=changes(setup, before, after, touched(own)),
        artifacts=artifacts(trace),
        unmet=tuple(unmet(trace)) or None,
    )
    taken = measured(trace, seen)
    return RecordedRun(
        document=document, before=before, after=after, trace=trace, measurements=taken, holder=run.holder
    )  # fmt: skip


def _resumption(r: JournalRecord) -> int:
    """Return in which resumption of its run an operation was planned, see `renumbered`; 0: in none."""
    first, dot, _ = r.key.split("/")[1].partition(".")
    return int(first[1:]) if dot and first.startswith("r") and first[1:].isdigit() else 0


def _reached(plan: Mapping[str, Any], seen: Mapping[str, Any] | None) -> str | None:
    """Return the digest of the goal where all of it was reached, and it is that of a manifest."""
    if seen and seen.get("reached") and not plan["target"].get("title"):
        return digest(plan["target"]["state"])
    return None


def weakest(starts: Iterable[Mapping[str, Any]], plan: Mapping[str, Any]) -> Any:
    """Return the weakest evidence of all times that a run was taken up, as its plan says where nothing else does."""
    known = [about["evidence"] for about in starts if about.get("evidence") in STRENGTH]
    return min(known, key=lambda e: STRENGTH[e]) if known else plan.get("fidelity")


def _goal(plan: Mapping[str, Any]) -> str:
    """Return what the plan led to, as a person calls it."""
    target, operations = plan["target"], plan["operations"]
    named = target.get("revision") or target.get("title")
    if named:
        return str(named)
    asked = [op for op in operations if op["reason"]["kind"] == "asked"]
    if asked and all(op["reason"]["kind"] in ASKED for op in operations):
        return ", ".join(f"{op['primitive']} {address_of(op['component'], op['arguments'])}" for op in asked)
    return "the manifest"
