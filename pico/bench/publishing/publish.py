"""A revision with its runs, measurements and pictures, as one folder or zip file that says what it is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pico.bench.publishing import crate
from pico.bench.publishing.gather import gather
from pico.bench.publishing.parts import File, Revision, file
from pico.bench.publishing.write import write
from pico.content.store import store_in
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history.lab.folder import LabFolder
from pico.model.record import record


@record
class Published:
    """What was written where: of which commit and state, with which evidence and runs, and its files."""

    path: str
    commit: str
    state: str
    evidence: str
    runs: tuple[str, ...]
    files: tuple[File, ...]
    diagnostics: tuple[Diagnostic, ...] = ()


def publish(
    folder: LabFolder,
    revision: str = "HEAD",
    out: Path | None = None,
    *,
    runs: Sequence[str] = (),
    pictures: bool = True,
    beside: Path = Path(),
) -> Published:
    """Write an RO-Crate of a revision to `out`: a new zip file (without it `LAB-COMMIT.zip` in the folder `beside`), or
    a new folder.

    With the runs that its commit added or that led to its state, or with those of its `runs` that are named. The same
    commit gives the same bytes. Raises PicoError, also where an artifact of a run is not here.
    """
    if out:
        _require_outside(folder, out)
    store = store_in(folder.history().common)
    found = gather(folder, store, revision, runs, pictures=pictures)
    path = out or beside / f"{found.setup.lab.name}-{found.commit.short}.zip"
    files = (*_described(found), *found.files)
    write(files, store, path, found.commit.time)
    return Published(
        path=str(path),
        commit=found.commit.id,
        state=found.state,
        evidence=found.evidence,
        runs=tuple(run.id for run in found.runs),
        files=files,
        diagnostics=tuple(_notes(found)),
    )


def _require_outside(folder: LabFolder, out: Path) -> None:
    """Raise PicoError for a folder in the lab: the manifests in it would be read as manifests of this lab."""
    if out.suffix.lower() != ".zip" and out.resolve().is_relative_to(folder.root.resolve()):
        hint = f"write beside it: `--out ../{out.name}`; or a file: `--out {out.name}.zip`"
        raise PicoError(error("usage", f"{out} is in the lab, and its manifests would be read as the lab's", hint=hint))


def _described(found: Revision) -> tuple[File, ...]:
    return (file(crate.NAME, crate.metadata(found), "what is in here, as an RO-Crate"),)


def _notes(found: Revision) -> list[Diagnostic]:
    """Return what somebody should know who publishes this."""
    notes = []
    if found.license is None:
        hint = "commit a LICENSE beside the lab's manifests; CC-BY-4.0 is usual for data"
        notes.append(warning("license", "the lab states no license, so nobody else may use this", hint=hint))
    if found.evidence == "planned":
        notes.append(warning("evidence", "no run is known that led to this state; the crate says so"))
    return notes
