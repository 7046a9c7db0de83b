"""What the commits of a lab hold of a run, in the form in which a journal keeps it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError
from pico.history.lab.folder import LabFolder
from pico.history.runs.committed import places_folded, places_in_history
from pico.history.runs.loading import carried_at, member_at
from pico.model.record import as_json
from pico.runs.damage import FromCommit
from pico.runs.document import RecordedRun


def carried(root: Path, run: str) -> FromCommit | None:
    """Return what the commits of the lab in `root` hold of a run; None if none has it. Raises PicoError for a lab or a
    repository that can't be read."""
    folder = LabFolder(root, history=True)
    if folder.repository is None:
        return None
    places = places_in_history(folder.repository, folder.root)
    names = sorted(name for name in places if name == run or name.startswith(f"{run}-r"))
    found = [carried_at(folder, places[name]) for name in names]
    if run not in places and (place := places_folded(folder.repository, places.values()).get(run)):
        found = [member_at(folder, run, place), *found]
    return _as_rows(run, found) if found and found[0].document.id == run else None


def carried_runs(root: Path, bench: str) -> tuple[str, ...]:
    """Return the ids of the runs of a bench that the commits of the lab in `root` hold, in the order in which they
    began; those of which nothing says on which bench they were are left out. Raises PicoError as `carried` does."""
    folder = LabFolder(root, history=True)
    if folder.repository is None:
        return ()
    places = places_in_history(folder.repository, folder.root)
    own = []
    for place in places.values():
        try:
            document = carried_at(folder, place).document
        except PicoError:  # a damaged document is told by `pico runs`
            continue
        if document.bench == bench:
            own.append((document.order, document.id, [str(one["id"]) for one in document.folded]))
    names = (name for _, run, folded in sorted(own) for name in (folded or [run]))
    return tuple(dict.fromkeys(name.partition("-r")[0] if _is_part(name) else name for name in names))


def _is_part(name: str) -> bool:
    """Return whether a name is that of what came after a run was taken up again: `...-r1`."""
    return name.rpartition("-r")[2].isdigit() and bool(name.rpartition("-r")[0])


def _as_rows(run: str, parts: list[RecordedRun]) -> FromCommit:
    first, last = parts[0].document, parts[-1].document
    outcome = None if last.outcome == "killed" else last.outcome
    head = (first.number, run, first.plan, "", first.started_at, last.ended_at or None, outcome, dict(last.tally),
            last.resumed)  # fmt: skip
    about = tuple(
        {
            "cause": as_json(one.document.cause), "evidence": one.document.evidence, "operator": one.document.operator,
            "seed": one.document.seed, "environment": dict(one.document.environment),
            "versions": dict(one.document.versions),
        }
        for one in parts
    )  # fmt: skip
    records = tuple(row for part in parts for row in _records(run, part))
    return FromCommit(head, about, _seen(parts[-1]), records)


def _seen(part: RecordedRun) -> Mapping[str, Any] | None:
    """Return how the bench was observed after a run, None if nobody looked."""
    observed = part.document.observed
    if observed is None or not observed.looked:
        return None
    told = part.measurements
    return {
        "at": observed.at,
        "components": {e.component: e.data for e in told if e.kind == "observation"},
        "expectations": [e.data for e in told if e.kind == "expectation"],
    }


def _records(run: str, part: RecordedRun) -> Iterator[tuple[str, str, str, str, Mapping[str, Any]]]:
    before: dict[str, Any] = {}
    for event in part.trace:
        key = f"{run}/{event.operation}/{event.attempt}"
        data = dict(event.data)
        if event.kind == "started":
            data = before[key] = dict(data.get("before") or {})
        elif event.kind in ("done", "failed", "unknown"):
            data |= {"key": key, "ended": 0.0} | ({"before": before[key]} if before.get(key) else {})
        yield key, event.kind, str(event.component), event.at, data
