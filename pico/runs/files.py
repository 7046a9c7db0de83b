"""A run as files: `run.json`, `trace.jsonl` and `measurements.jsonl` in `runs/YYYY/MM/<run id>/`, written once.

Files survive clone, rebase and squash, where notes and trailers do not. Each holds canonical JSON: keys sorted, floats
rounded to 1e-6, lines that end in LF. What does not fit into a commit goes, packed, to the content store.
"""

from __future__ import annotations

import gzip
import hashlib
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from pico.diagnostics import Diagnostic, warning
from pico.model.record import canonical
from pico.model.trace.run import Artifact, FileRef, Run, TraceEvent
from pico.runs.reading import read_document

DOCUMENT, TRACE, MEASUREMENTS = "run.json", "trace.jsonl", "measurements.jsonl"
INLINE = 64 << 10
"""Bytes of the largest file of a run that goes into a commit."""
FOLDED = 8 * INLINE
"""Bytes of the largest file of runs that are folded into one, each of which would have had files of its own."""
_PATH = re.compile(r"(?:.+/)?runs/\d{4}/\d{2}/(?P<id>[^/]+)/run\.json")

Keep = Callable[[bytes], object]
"""Keeps bytes where they can be found by their SHA-256, as `Store.put` does."""


def run_folder(document: Run) -> str:
    """Return where the files of a run lie, relative to the lab: `runs/2026/11/<id>`, by when it started."""
    return f"runs/{document.started_at[:4]}/{document.started_at[5:7]}/{document.id}"


def run_files(
    document: Run,
    trace: Iterable[TraceEvent] = (),
    measurements: Iterable[TraceEvent] = (),
    *,
    keep: Keep | None = None,
) -> dict[str, bytes]:
    """Return the files of a run by path relative to the lab, the document with the hashes of the other two.

    Where there is somebody to `keep` it, a file above INLINE (FOLDED of runs in one, and of what a script did) goes
    there packed by gzip, and is an artifact.
    """
    texts = {TRACE: jsonl(trace), MEASUREMENTS: jsonl(measurements)}
    most = FOLDED if document.folded or document.cause.kind == "recording" else INLINE
    large = {name: packed(data) for name, data in texts.items() if keep and len(data) > most}
    for data in large.values():
        assert keep is not None
        keep(data)
    beside = {name: data for name, data in texts.items() if name not in large}
    document = replace(
        document,
        files=references(beside),
        artifacts=(*document.artifacts, *(_artifact(name, data) for name, data in large.items())),
    )
    files = {DOCUMENT: (canonical(document) + "\n").encode(), **beside}
    return {f"{run_folder(document)}/{name}": data for name, data in files.items()}


def references(files: Mapping[str, bytes]) -> dict[str, FileRef]:
    """Return what a document says of the files beside it, by name."""
    return {name: FileRef(sha256=_sha256(data), size=len(data)) for name, data in files.items()}


def read_runs(files: Mapping[str, bytes], diagnostics: list[Diagnostic] | None = None) -> tuple[Run, ...]:
    """Return the documents among `files`, by path, in the order in which the runs started.

    What is no run's document is passed over; one that is damaged, too, and a warning that names it is appended to
    `diagnostics`.
    """
    found = []
    for path, data in sorted(files.items()):
        match = _PATH.fullmatch(path)
        if match:
            document = read_document(path, data, match["id"])
            found += [document] if isinstance(document, Run) else []
            if diagnostics is not None and isinstance(document, Diagnostic):
                diagnostics.append(document)
    return tuple(sorted(found, key=lambda d: d.order))


def intact(document: Run, files: Mapping[str, bytes], diagnostics: list[Diagnostic] | None = None) -> bool:
    """Return whether the files that a document names are there, as they were written.

    `files` by path, as `run_files` gave them; a warning for each that is not is appended to `diagnostics`.
    """
    found = [trouble for name in sorted(document.files) if (trouble := _trouble(document, name, files))]
    if diagnostics is not None:
        diagnostics += found
    return not found


def jsonl(events: Iterable[TraceEvent]) -> bytes:
    """Return events as canonical JSON, one a line."""
    return "".join(canonical(event) + "\n" for event in events).encode()


def numbered(events: Sequence[TraceEvent]) -> tuple[TraceEvent, ...]:
    """Return the events in their order, `seq` counting from 1."""
    return tuple(replace(event, seq=i) for i, event in enumerate(events, 1))


def packed(data: bytes) -> bytes:
    """Return `data` packed by gzip, the same bytes each time."""
    return gzip.compress(data, compresslevel=6, mtime=0)


def _artifact(name: str, data: bytes) -> Artifact:
    return Artifact(name=f"{name}.gz", sha256=_sha256(data), size=len(data), media_type="application/gzip")


def _trouble(document: Run, name: str, files: Mapping[str, bytes]) -> Diagnostic | None:
    path = str(PurePosixPath(run_folder(document)) / name)
    data, told = files.get(path), document.files[name]
    if data is None:
        return warning("run-file", f"{path} is missing", hint="the commit that carried the run first has it")
    if len(data) != told.size or _sha256(data) != told.sha256:
        hint = "it was changed after it was written; the commit that carried the run first has it as it was"
        return warning("run-file", f"{path} is not what {DOCUMENT} beside it says", hint=hint)
    return None


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
