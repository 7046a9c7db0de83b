"""What was measured in a run as a table: a row for each measurement, beside the tunables that the run changed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.model.measurement import Measurement, measurement_from_json
from pico.model.operation import touched_by
from pico.model.record import record
from pico.model.trace.run import TraceEvent

FIRST = ("seq", "t", "at", "measured")
"""Columns of every row: its number in the trace, seconds on the bench's clock, the wall time (UTC), and what was
measured, by address."""


@record
class Row:
    """One measurement of a run: at event `seq` of its trace, `t` seconds after its first operation began, by the wall
    `at`; `tunables` that the run changed as they then stood, by address (`p2.pose.x`)."""

    seq: int
    t: float
    at: str
    measurement: Measurement
    tunables: Mapping[str, Any]
    run: str = ""
    """Its run, where there are several in a table."""

    @property
    def numbers(self) -> dict[str, float | None]:
        """The numbers that were measured and their sigmas, by address: `cam.centroid.x`, `cam.centroid.x_sigma`."""
        found: dict[str, float | None] = {}
        for name, (value, sigma, _) in self.measurement.numbers.items():
            key = f"{self.measurement.address}.{name}" if name else self.measurement.address
            found |= {key: value, f"{key}_sigma": sigma}
        return found

    @property
    def flat(self) -> dict[str, Any]:
        """All of it in columns, those of `FIRST` before the others."""
        first = (self.seq, self.t, self.at, self.measurement.address)
        array = {f"{self.measurement.address}.sha256": a.sha256} if (a := self.measurement.array) else {}
        of = {"run": self.run} if self.run else {}
        return of | dict(zip(FIRST, first, strict=True)) | dict(self.tunables) | self.numbers | array


def rows(trace: Sequence[TraceEvent]) -> tuple[Row, ...]:
    """Return the measurements of a trace in their order, with where what the run changed stood at each: before its
    first change as that found it. A tunable that nobody looked at before is left out."""
    changed = {(c, t) for event in trace if event.kind == "intent" for c, t in _changed(event)}
    known = _at_first(trace, changed)
    found = []
    for event in trace:
        if event.component is not None:
            part = event.data.get("before" if event.kind == "started" else "after")
            known |= dict(_values(event.component, part, changed)) if isinstance(part, Mapping) else {}
        taken = event.data.get("data", {}).get("measurement") if event.kind == "done" else None
        if isinstance(taken, Mapping):
            found.append(Row(
                seq=event.seq, t=event.t, at=event.at, measurement=measurement_from_json(taken),
                tunables=dict(sorted(known.items())),
            ))  # fmt: skip
    return tuple(found)


def rows_of(runs: Sequence[tuple[str, Sequence[TraceEvent]]]) -> tuple[Row, ...]:
    """Return the measurements of runs, by name and trace, one after another; of several each row has its run."""
    if len(runs) == 1:
        return rows(runs[0][1])
    return tuple(replace(row, run=name) for name, trace in runs for row in rows(trace))


def _at_first(trace: Sequence[TraceEvent], changed: set[tuple[str, str]]) -> dict[str, Any]:
    """Return what a run changed as it was seen first, but for what operations of others had changed by then."""
    found: dict[str, Any] = {}
    lost = set[tuple[str, str]]()
    for event in trace:
        if event.kind == "intent":
            lost |= {one for one in _changed(event) if one[0] != event.component}
        elif event.kind == "started" and event.component and isinstance(part := event.data.get("before"), Mapping):
            found = dict(_values(event.component, part, changed - lost)) | found
    return found


def _changed(event: TraceEvent) -> Iterator[tuple[str, str]]:
    if event.component is None or event.data.get("primitive") not in ("measure", "park"):
        yield from touched_by(event.component or "", event.data.get("arguments", {}))


def _values(name: str, part: Mapping[str, Any], changed: set[tuple[str, str]]) -> Iterator[tuple[str, Any]]:
    for tunable, live in part.get("values", {}).items():
        if (name, tunable) in changed and live.get("status") == "known":
            yield f"{name}.{tunable}", live.get("value")
    if (name, "pose") in changed and isinstance(part.get("pose"), Mapping):
        yield from ((f"{name}.pose.{axis}", part["pose"].get(axis)) for axis in ("x", "y", "yaw"))


def scanned(trace: Sequence[TraceEvent]) -> tuple[str, ...]:
    """Return the numbers that a run set otherwise from one measurement to another, by address, in the order in which
    they first changed: not what was set in passing, nor what stood still and was seen a little otherwise."""
    stands: dict[str, float] = {}
    last: dict[str, float] | None = None  # as it all stood at the last measurement
    found: dict[str, None] = {}
    for event in trace:
        if event.kind == "intent":
            for address, before, after in _commanded(event):
                stands.pop(address, None)  # in the order of the last changes
                stands[address] = after
                if last is not None:
                    last.setdefault(address, before)
        elif event.kind == "done" and event.data.get("data", {}).get("measurement"):
            found |= dict.fromkeys(a for a, v in stands.items() if last is not None and last[a] != v)
            last = dict(stands)
    return tuple(found)


def _commanded(event: TraceEvent) -> Iterator[tuple[str, float, float]]:
    """Yield the numbers that an operation sets, each with what it was before; nothing of what is set in passing."""
    told = event.data.get("arguments", {})
    reason = event.data.get("reason")
    if event.component is None or (isinstance(reason, Mapping) and reason.get("kind") == "interlock"):
        return
    ends = told.get("from"), told.get("to")
    if "tunable" in told:
        yield from _moved(f"{event.component}.{told['tunable']}", *ends)
    elif all(isinstance(end, Mapping) and isinstance(end.get("pose"), Mapping) for end in ends):
        for axis in ("x", "y", "yaw"):
            yield from _moved(f"{event.component}.pose.{axis}", *(end["pose"].get(axis) for end in ends))


def _moved(address: str, before: object, after: object) -> Iterator[tuple[str, float, float]]:
    if all(isinstance(end, int | float) and not isinstance(end, bool) for end in (before, after)):
        yield address, float(before), float(after)  # type: ignore[arg-type]


def columns(found: Sequence[Row]) -> list[str]:
    """Return the columns of some rows: those of all, then tunables, then what was measured."""
    tunables = sorted({name for row in found for name in row.tunables})
    rest = dict.fromkeys(name for row in found for name in row.flat if name not in tunables and name not in FIRST)
    first = (*(("run",) if "run" in rest else ()), *FIRST)
    return [*first, *tunables, *(name for name in rest if name != "run")]


def as_csv(found: Sequence[Row]) -> str:
    """Return rows as CSV with a head; what a row does not have is empty."""
    out = io.StringIO()
    writer = csv.DictWriter(out, columns(found), lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.flat for row in found)
    return out.getvalue()
