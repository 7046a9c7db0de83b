"""One run of a journal as its document, its trace and what was measured."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pico.model.diff import Change
from pico.model.expectation import Expected
from pico.model.lab import Setup
from pico.model.plan import LabRef
from pico.model.record import digest
from pico.model.run import STRENGTH, Cause, Evidence, RunDocument, RunEnd, Seen, TraceEvent
from pico.model.state import LabState, state_from_json
from pico.runs.journal import JournalRecord, RunRecord
from pico.runs.states import changes, digest_of, state_left, state_seen, touched
from pico.runs.trace import busy, measured, tally, trace_events

ASKED = ("asked", "parked", "interlock", "held")


@dataclass(frozen=True)
class Kept:
    """What the journal kept of a run. `part`: how often it had been taken up again when a commit took what was before
    that; 0 for a whole run."""

    run: RunRecord
    plan: Mapping[str, Any]
    about: Sequence[Mapping[str, Any]]
    seen: Mapping[str, Any] | None
    records: Sequence[JournalRecord]
    part: int = 0

    @property
    def id(self) -> str:
        """The id of the document."""
        return f"{self.run.run}-r{self.part}" if self.part else self.run.run

    @property
    def own(self) -> list[JournalRecord]:
        """The records that no commit has yet: resumption n calls its operations `rn.op1`."""
        return [r for r in self.records if _resumption(r) >= self.part]


@dataclass(frozen=True)
class Recorded:
    """A run, ready to be written; `after`: the state that was observed in the end."""

    document: RunDocument
    after: LabState
    trace: Sequence[TraceEvent] = field(default=())
    measurements: Sequence[TraceEvent] = field(default=())


def recorded(setup: Setup, kept: Kept) -> Recorded:
    """Return a run as it is to be written; `setup`: the bench as it is now."""
    run, plan, own = kept.run, kept.plan, kept.own
    name = plan["lab"]["name"]
    earlier = [r for r in kept.records if _resumption(r) < kept.part]
    before = state_left(setup, state_from_json(name, plan["base"]["state"]), earlier)
    after = state_seen(setup, kept.seen["components"]) if kept.seen else state_left(setup, before, own)
    trace, observed = trace_events(own), digest_of(setup, after)
    about = kept.about[min(kept.part, len(kept.about) - 1)] if kept.about else {}
    document = RunDocument(
        id=kept.id,
        number=run.number,
        lab=LabRef(**plan["lab"]),
        parent=plan["base"].get("commit"),
        state_before=digest_of(setup, before),
        state_after=_reached(kept) or observed,
        observed=Seen(at=kept.seen["at"] if kept.seen else own[-1].at, state=observed, looked=kept.seen is not None),
        plan=plan["digest"],
        goal=_goal(plan),
        goal_commit=plan["target"].get("commit"),
        cause=_cause(kept, about),
        evidence=_evidence(kept),
        seed=about.get("seed"),
        operator=about.get("operator", ""),
        calibration=plan.get("calibration"),
        environment=about.get("environment", {}),
        versions=about.get("versions", {}),
        started_at=own[0].at if kept.part else run.started_at,
        ended_at=run.finished_at or own[-1].at,
        outcome=_outcome(run),
        seconds=busy(own),
        tally=tally(own, int((run.tally or {}).get("skipped", 0))),
        resumed=run.resumed,
        expectations=_expectations(kept.seen),
        changes=changes(setup, before, after, touched(own)),
    )
    return Recorded(document, after, trace, measured(kept.seen, trace[-1].t))


def afterwards(setup: Setup, run: Recorded, now: LabState) -> tuple[Change, ...]:
    """Return what has changed since the end of a run, beyond tolerance."""
    found = changes(setup, run.after, now, run.after.components.keys() | now.components.keys())
    return tuple(c for c in found if not c.tolerated)


def _resumption(r: JournalRecord) -> int:
    """Return in which resumption of its run an operation was planned, see `renumbered`; 0: in none."""
    first, dot, _ = r.key.split("/")[1].partition(".")
    return int(first[1:]) if dot and first.startswith("r") and first[1:].isdigit() else 0


def _reached(kept: Kept) -> str | None:
    """Return the digest of the goal where all of it was reached, and it is that of a manifest."""
    if kept.seen and kept.seen.get("reached") and not kept.plan["target"].get("title"):
        return digest(kept.plan["target"]["state"])
    return None


def _evidence(kept: Kept) -> Evidence:
    """Return the weakest evidence of all times that the run was taken up."""
    known = [a["evidence"] for a in kept.about if a.get("evidence") in STRENGTH]
    weakest: Evidence = min(known, key=lambda e: STRENGTH[e]) if known else kept.plan["fidelity"]
    return weakest


def _cause(kept: Kept, about: Mapping[str, Any]) -> Cause:
    return Cause(kind="resume", of=kept.run.run) if kept.part else Cause(**about.get("cause", {}))


def _goal(plan: Mapping[str, Any]) -> str:
    """Return what the plan led to, as a person calls it."""
    target, operations = plan["target"], plan["operations"]
    named = target.get("revision") or target.get("title")
    if named:
        return str(named)
    asked = [op for op in operations if op["reason"]["kind"] == "asked"]
    if asked and all(op["reason"]["kind"] in ASKED for op in operations):
        return ", ".join(f"{op['primitive']} {_address(op)}" for op in asked)
    return "the manifest"


def _address(op: Mapping[str, Any]) -> str:
    tunable = op["arguments"].get("tunable")
    return f"{op['component']}.{tunable}" if tunable else str(op["component"])


def _outcome(run: RunRecord) -> RunEnd:
    return run.outcome or "killed"


def _expectations(seen: Mapping[str, Any] | None) -> tuple[Expected, ...]:
    return tuple(Expected(**e) for e in seen["expectations"]) if seen else ()


def read_plan(text: str) -> Mapping[str, Any]:
    """Return a plan as the journal kept it, as plain data: it may be of an older PICO."""
    found: Mapping[str, Any] = json.loads(text)
    return found
