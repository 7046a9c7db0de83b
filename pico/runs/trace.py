"""The records of a journal as the trace of a run."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.model.trace.run import Artifact, TraceEvent, tally
from pico.runs.files import numbered
from pico.runs.journal import JournalRecord

ENDS = ("done", "failed", "unknown")


def trace_events(
    records: Sequence[JournalRecord], states: Mapping[int, tuple[str, str]], actor: Callable[[JournalRecord], str]
) -> tuple[TraceEvent, ...]:
    """Return the trace of some records: each with the time on the bench's clock, as far as its operation ended. What
    ended an operation has the digests of the `states` it led from and to, by record, and whose operation it was."""
    spans = _spans(records)
    zero = min((start for start, _ in spans.values()), default=0.0)
    events, now = [], 0.0
    for r in records:
        known = spans.get(r.key)
        if known:
            now = max(now, known[0 if r.kind in ("intent", "started") else 1] - zero)
        _, operation, attempt = r.key.split("/")
        events.append(
            TraceEvent(
                t=now, at=r.at, seq=0, kind=r.kind, operation=operation, attempt=int(attempt), component=r.component,
                data=_data(r), **_ends(r, states, actor),
            )
        )  # fmt: skip
    return numbered(events)


def _ends(
    r: JournalRecord, states: Mapping[int, tuple[str, str]], actor: Callable[[JournalRecord], str]
) -> dict[str, str | None]:  # fmt: skip
    if r.seq not in states:
        return {}
    before, after = states[r.seq]
    return {"before": before, "after": after, "actor": actor(r) or None}


def busy(records: Sequence[JournalRecord]) -> float:
    """Return how long something moved, on the bench's clock [s]; what ran side by side counts once."""
    total, until = 0.0, float("-inf")
    for start, end in sorted(_spans(records).values()):
        total += max(0.0, end - max(start, until))
        until = max(until, end)
    return total


def counted(records: Sequence[JournalRecord], skipped: int) -> dict[str, int]:
    """Return how many operations ended how, each by its last attempt, and as the bench was seen in the end."""
    last: dict[str, str] = {}
    for r in records:
        operation = r.key.split("/")[1]
        if r.kind in ENDS:
            last[operation] = r.kind
        elif r.kind == "started":
            last[operation] = "unknown"
        elif r.kind == "resolved":
            last[operation] = str(r.data["outcome"])
    return tally(last.values()) | {"skipped": skipped}


def measured(trace: Sequence[TraceEvent], seen: Mapping[str, Any] | None) -> tuple[TraceEvent, ...]:
    """Return what was measured in a run, then what was observed of the bench at its end, expectations first."""
    taken = [replace(e, kind="measurement", data=data) for e in trace if (data := measurement_in(e))]
    if seen is None:
        return numbered(taken)
    at, t = str(seen["at"]), trace[-1].t
    said = [TraceEvent(t=t, at=at, seq=0, kind="expectation", data=e) for e in seen["expectations"]]
    parts = sorted(seen["components"].items())
    return numbered(
        [*taken, *said, *(TraceEvent(t=t, at=at, seq=0, kind="observation", component=n, data=p) for n, p in parts)]
    )


def measurement_in(event: TraceEvent) -> Mapping[str, Any] | None:
    """Return the measurement that an operation of a trace brought, as JSON; None where it brought none."""
    found = event.data.get("data", {}).get("measurement") if event.kind == "done" else None
    return found if isinstance(found, Mapping) else None


def _plain(measurable: str) -> str:
    """Return what was measured as it may stand in the name of a file, also where kernels are named."""
    return re.sub(r"[^\w.=]+", "-", measurable).strip("-")


def artifacts(trace: Sequence[TraceEvent]) -> tuple[Artifact, ...]:
    """Return the arrays that were measured in a run, and what its optimizations tried, as they lie in the content
    store."""
    taken = [
        (e, m["component"], m["measurable"], m["array"]) for e in trace if (m := measurement_in(e)) and m.get("array")
    ]
    tried = [(e, e.component, what, points) for e in trace for what, points in _tried(e.data.get("data", {}))]
    return tuple(
        Artifact(
            name=f"{e.operation}-{component}-{_plain(what)}.npy", sha256=array["sha256"], size=array["size"],
            component=component, seq=e.seq, shape=tuple(array["shape"]), dtype=array["dtype"],
        )
        for e, component, what, array in sorted([*taken, *tried], key=lambda one: one[0].seq)
    )  # fmt: skip


def _tried(data: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield what was tried for goals that were sought first, then for the one itself, each with what it is called."""
    for stage in data.get("stages") or ():
        if points := stage.get("points"):
            yield f"{stage.get('goal', '')}.points", points
    if points := data.get("points"):
        yield "points", points


def unmet(trace: Sequence[TraceEvent]) -> Iterator[str]:
    """Yield the goals that were sought in a run and not met, each once; one that was sought again by how that ended."""
    ended = {str(found["goal"]): found["met"] for e in trace if "met" in (found := e.data.get("data", {}))}
    yield from (goal for goal, met in ended.items() if not met)


def _spans(records: Sequence[JournalRecord]) -> dict[str, tuple[float, float]]:
    """Return start and end of each attempt on the bench's clock [s], of those of which that is known."""
    return {
        r.key: (r.data["ended"] - r.data["seconds"], r.data["ended"])
        for r in records
        if r.kind in ENDS and r.data.get("ended")
    }


def _data(r: JournalRecord) -> Mapping[str, Any]:
    if r.kind == "started":
        return {"before": r.data} if r.data else {}
    if r.kind in ENDS:  # what it was before, `started` has said
        return {k: v for k, v in r.data.items() if k not in ("key", "before", "ended")}
    return r.data
