"""Many small runs as one, and each of them back as it was.

A session that sets tunables one by one makes a run of each. Committed as they are, they would be three files a setting;
those that come one after the other, of one holder of the bench, are folded: one document, one trace, one file of
measurements. Each of them keeps its id, its digests and its operations. What was observed after each, and was observed
so before, is written once.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.record import as_json, canonical, digest
from pico.model.setup import Setup
from pico.model.trace.run import FOLD, SHARED, Run, TraceEvent
from pico.runs.document import RecordedRun
from pico.runs.files import FOLDED, MEASUREMENTS, TRACE, jsonl, numbered, references
from pico.runs.reading import members
from pico.runs.states import changes

MOST = 256
"""So many runs are folded into one at most."""


def fold(setup: Setup, runs: Iterable[RecordedRun]) -> tuple[RecordedRun, ...]:
    """Return runs, in the order in which they began, with single operations of one holder folded where they follow on
    one another. `setup`: the bench as it is now, whose tolerances say what they changed."""
    found: list[RecordedRun] = []
    for _, group in groupby(runs, key=_kind):
        for some in _pieces(list(group)):
            found += [_folded(setup, some)] if len(some) > 1 else some
    return tuple(found)


def unfolded(run: RecordedRun) -> tuple[RecordedRun, ...]:
    """Return the runs that are folded into one as they were before; none where it is not folded.

    One that is not what its document says has a warning among its `diagnostics`.
    """
    seen: dict[str, Mapping[str, Any]] = {}
    found = []
    for document in members(run.document):
        trace = _own(run.trace, document)
        taken = _own(run.measurements, document)
        seen |= {e.component: e.data for e in taken if e.kind == "observation" and e.component}
        measurements = _observed(document, trace, taken, seen)
        missing = run.missing.intersection(a.sha256 for a in document.artifacts)
        one = RecordedRun(document=document, trace=trace, measurements=measurements, missing=missing)
        found.append(replace(one, diagnostics=(*run.diagnostics, *_changed(run.document, one))))
    return tuple(found)


def _kind(run: RecordedRun) -> str:
    """Return what runs must have in common to be folded; an id where one must not be."""
    d = run.document
    plain = d.cause.kind == "single" and d.outcome == "done" and not d.resumed and d.observed and d.observed.looked
    if not plain:
        return d.id
    return canonical([run.holder, {key: getattr(d, key) for key in SHARED}, sorted(_seen(run))])


def _pieces(runs: list[RecordedRun]) -> list[list[RecordedRun]]:
    """Return runs in pieces, none of which is too large for a commit."""
    found: list[list[RecordedRun]] = []
    size = FOLDED
    for run in runs:
        own = len(jsonl(_marked(run.document, run.trace)))
        if size + own > FOLDED or len(found[-1]) == MOST:
            found.append([])
            size = 0
        found[-1].append(run)
        size += own
    return found


def _folded(setup: Setup, runs: Sequence[RecordedRun]) -> RecordedRun:
    first, last = runs[0], runs[-1]
    documents = [_whole(run) for run in runs]
    assert first.before is not None and last.after is not None  # of a journal
    among = {c.component for d in documents for c in d.changes}
    return replace(
        last,
        document=replace(
            last.document,
            id=f"{first.document.id}{FOLD}",
            number=first.document.number,
            state_before=first.document.state_before,
            plan=digest([d.plan for d in documents]),
            goal=_goal([d.goal for d in documents]),
            started_at=first.document.started_at,
            seconds=sum(d.seconds for d in documents),
            tally={end: sum(d.tally.get(end, 0) for d in documents) for end in last.document.tally},
            unmet=tuple(dict.fromkeys(goal for d in documents for goal in d.unmet or ())) or None,
            changes=changes(setup, first.before, last.after, among),
            artifacts=tuple(replace(a, seq=None) for d in documents for a in d.artifacts),
            folded=tuple({k: v for k, v in as_json(d).items() if v and k not in SHARED} for d in documents),
        ),
        before=first.before,
        trace=tuple(event for run in runs for event in _marked(run.document, run.trace)),
        measurements=_measurements(runs),
    )  # fmt: skip


def _whole(run: RecordedRun) -> Run:
    """Return the document of a run as it would be beside its own files."""
    texts = {TRACE: jsonl(run.trace), MEASUREMENTS: jsonl(run.measurements)}
    return replace(run.document, files=references(texts))


def _goal(goals: Sequence[str]) -> str:
    known = list(dict.fromkeys(goals))
    if len(known) == 1:
        return f"{known[0]}, {len(goals)} times"
    more = f" and {len(known) - 3} more" if len(known) > 3 else ""
    return f"{len(goals)} operations: {', '.join(known[:3])}{more}"


def _marked(document: Run, events: Iterable[TraceEvent]) -> tuple[TraceEvent, ...]:
    return tuple(replace(event, run=document.id) for event in events)


def _own(events: Iterable[TraceEvent], document: Run) -> tuple[TraceEvent, ...]:
    return tuple(replace(event, run=None) for event in events if event.run == document.id)


def _seen(run: RecordedRun) -> set[str]:
    return {e.component for e in run.measurements if e.kind == "observation" and e.component}


def _measurements(runs: Iterable[RecordedRun]) -> tuple[TraceEvent, ...]:
    """Return what was measured in runs, without what was observed of a component as it was before."""
    seen: dict[str | None, str] = {}
    found: list[TraceEvent] = []
    for run in runs:
        for event in _marked(run.document, run.measurements):
            text = canonical(event.data)
            if event.kind != "observation" or seen.get(event.component) != text:
                found.append(event)
            if event.kind == "observation":
                seen[event.component] = text
    return tuple(found)


def _observed(
    document: Run, trace: Sequence[TraceEvent], taken: Iterable[TraceEvent], seen: Mapping[str, Mapping[str, Any]]
) -> tuple[TraceEvent, ...]:
    """Return what was measured in a run, then all that was observed of the bench at its end: see `trace.measured`."""
    others = [event for event in taken if event.kind != "observation"]
    t, at = trace[-1].t if trace else 0.0, document.observed.at if document.observed else ""
    parts = (TraceEvent(t=t, at=at, seq=0, kind="observation", component=n, data=p) for n, p in sorted(seen.items()))
    return numbered([*others, *parts])


def _changed(fold: Run, run: RecordedRun) -> list[Diagnostic]:
    texts = {TRACE: jsonl(run.trace), MEASUREMENTS: jsonl(run.measurements)}
    wrong = [name for name, told in references(texts).items() if run.document.files.get(name) != told]
    hint = "it was changed after it was written; the commit that carried the run first has it as it was"
    return [
        warning("run-file", f"{name} of {fold.id} does not hold what {run.document.id} did", hint=hint)
        for name in wrong
    ]


def folded_ids(document: bytes) -> tuple[str, ...]:
    """Return the ids of the runs that are folded into the one whose `run.json` this is; none of a damaged one."""
    try:
        return tuple(str(one["id"]) for one in json.loads(document).get("folded", ()))
    except (ValueError, KeyError, TypeError, AttributeError):
        return ()
