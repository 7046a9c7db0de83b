"""A run as documents of bluesky's event model: `start`, `descriptor`, `event`, `stop`, as plain data.

Streams: `transitions`, an event for each operation; one for each thing that was measured (`cam-centroid`), with where
the tunables then stood that the run changed. Keys have `-` where addresses have `.`, which documents do not
allow, or ` | `.
"""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from pico.base import clock
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.runs.document import RecordedRun
from pico.runs.table import Row, rows

Document = dict[str, Any]
_SPACE = uuid.UUID("c1f0a5f3-6f5d-5b0e-9d0e-6d6f0d1f7a11")
"""Under which the ids of documents are made: the same run gives the same ones."""
_STATUS = {"done": "success", "failed": "fail", "interrupted": "abort", "killed": "abort"}
_POSE = {"x": "mm", "y": "mm", "yaw": "deg"}
_ENDS = ("done", "failed", "unknown", "resolved")


def documents(run: RecordedRun, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[tuple[str, Document]]:
    """Yield the documents of a run, each with the name of its kind, in the order in which event model wants them.

    `units` of tunables by address, see `units_of`.
    """
    start = _id(run.document.id)
    counts: dict[str, int] = {}
    yield "start", _start(run, start)
    for name, stream in (("transitions", _transitions(run)), *_measured(rows(run.trace), units)):
        if not stream:
            continue
        counts[name] = len(stream)
        descriptor = _id(run.document.id, name)
        yield "descriptor", {
            "uid": descriptor, "run_start": start, "time": stream[0][0], "name": name, "data_keys": _keys(stream),
        }  # fmt: skip
        for n, (at, data, _) in enumerate(stream, 1):
            yield "event", {
                "uid": _id(run.document.id, name, str(n)), "descriptor": descriptor, "seq_num": n, "time": at,
                "data": data, "timestamps": dict.fromkeys(data, at), "filled": {},
            }  # fmt: skip
    yield "stop", {
        "uid": _id(run.document.id, "stop"), "run_start": start, "time": clock.epoch(run.document.ended_at),
        "exit_status": _STATUS[run.document.outcome], "reason": "", "num_events": counts,
    }  # fmt: skip


def units_of(setup: Setup) -> dict[str, str]:
    """Return the units of the tunables of a bench by address."""
    tunables = ((n, t, kind) for n in setup.lab.inventory for t, kind in setup.type_of(n).tunables.items())
    poses = {f"{n}.pose.{axis}": unit for n in setup.lab.inventory for axis, unit in _POSE.items()}
    return {f"{n}.{t}": kind.unit for n, t, kind in tunables if kind.unit} | poses


def _start(run: RecordedRun, uid: str) -> Document:
    d = run.document
    return {
        "uid": uid, "time": clock.epoch(d.started_at), "scan_id": d.number, "plan_name": d.goal, "pico_run": d.id,
        "pico_lab": d.lab.name, "pico_lab_digest": d.lab.digest, "pico_commit": d.parent or "", "pico_plan": d.plan,
        "pico_state_before": d.state_before, "pico_state_after": d.state_after, "pico_cause": as_json(d.cause),
        "pico_evidence": d.evidence, "operator": d.operator, "versions": dict(d.versions),
    }  # fmt: skip


Stream = list[tuple[float, dict[str, Any], Mapping[str, str]]]
"""Events: when [s since 1970], the data, and the units of those that have one."""


def _transitions(run: RecordedRun) -> Stream:
    meant = {(e.run, e.operation, e.attempt): e.data for e in run.trace if e.kind == "intent"}
    found: Stream = []
    for event in run.trace:
        if event.kind not in _ENDS:
            continue
        of = meant.get((event.run, event.operation, event.attempt), {})
        data = {
            "operation": event.operation or "", "attempt": event.attempt or 0, "component": event.component or "",
            "primitive": str(of.get("primitive", "")), "outcome": str(event.data.get("outcome", event.kind)),
            "seconds": float(event.data.get("seconds") or 0.0), "bench_time": event.t, "actor": event.actor or "",
            "state_before": event.before or "", "state_after": event.after or "",
        }  # fmt: skip
        found.append((clock.epoch(event.at), data, {"seconds": "s", "bench_time": "s"}))
    return found


def _measured(found: Sequence[Row], units: Mapping[str, str]) -> Iterator[tuple[str, Stream]]:
    """Yield a stream for each thing that was measured: its events have the keys that all of them have."""
    for address in dict.fromkeys(row.measurement.address for row in found):
        own = [row for row in found if row.measurement.address == address]
        every = [{k: v for k, v in _data(row).items() if v is not None} for row in own]
        common = [key for key in every[0] if all(key in data for data in every)]
        if common:
            yield (
                _key(address),
                [
                    (clock.epoch(row.at), {_key(key): data[key] for key in common}, _units(row, units))
                    for row, data in zip(own, every, strict=True)
                ],
            )


def _data(row: Row) -> dict[str, Any]:
    return {k: v for k, v in row.flat.items() if k not in ("seq", "at", "measured")}


def _units(row: Row, known: Mapping[str, str]) -> dict[str, str]:
    units = {"t": "s"} | {_key(name): known[name] for name in row.tunables if name in known}
    for name, (_, _, unit) in row.measurement.numbers.items():
        key = _key(f"{row.measurement.address}.{name}" if name else row.measurement.address)
        units |= {key: unit, f"{key}_sigma": unit} if unit else {}
    return units


def _keys(stream: Stream) -> dict[str, Document]:
    _, data, units = stream[0]
    return {
        key: {"source": "pico", "dtype": _dtype(value), "shape": []} | ({"units": units[key]} if key in units else {})
        for key, value in data.items()
    }


def _dtype(value: object) -> str:
    if isinstance(value, bool):
        return "boolean"
    return "integer" if isinstance(value, int) else "number" if isinstance(value, float) else "string"


def _key(address: str) -> str:
    return address.replace(" | ", "-").replace(".", "-")


def _id(*words: str) -> str:
    return str(uuid.uuid5(_SPACE, "/".join(words)))
