"""The Lab that a bench itself keeps, with its component types: plan and apply go by it, whatever the working tree says.

It is `lab.json` beside the journal: the manifest files that describe the bench, as text. The edge writes it, and writes
its SHA-256 into Git's own folder: a checkout overwrites whatever lies in `.pico` where somebody has committed that.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.base.plain_files import read_file
from pico.base.state_files import OWN_LAB
from pico.diagnostics import PicoError, error
from pico.edge.protocol import OwnLab
from pico.manifest.files import bench_files, read_folder, shown_path
from pico.places.bench import BenchPlace
from pico.places.lab import lab_place
from pico.places.record import SHARED
from pico.places.seals import sealed_labs, write_seals

if TYPE_CHECKING:
    from pico.model.setup import Setup

NAMED = "the bench's own "
"""What stands before the names of its files in diagnostics."""
CODE = "bench-lab"
_HINT = "`pico bench update` shows what the working tree describes, and lets the bench adopt that"


def read(place: BenchPlace) -> OwnLab | None:
    """Return the Lab that the bench at `place` keeps, None where it keeps none yet; raises PicoError."""
    path = OWN_LAB.path(place.folder)
    try:
        data = read_file(path) if os.path.lexists(path) else None
        _require_sealed(place, path, data)
        if data is None:
            return None
    except OSError as exc:
        raise PicoError(OWN_LAB.unreadable(path, exc.strerror or str(exc))) from exc
    return OWN_LAB.made(path, data, _own_lab)


def _own_lab(document: Mapping[str, Any]) -> OwnLab:
    files = {str(name): str(text) for name, text in document["files"].items()}
    return OwnLab(files=files, by=str(document["by"]), at=str(document["at"]))


def write(place: BenchPlace, lab: OwnLab) -> None:
    """Let the bench at `place` keep a Lab, whole or not at all; raises PicoError."""
    data = OWN_LAB.dump({"by": lab.by, "at": lab.at, "files": dict(lab.files)}, indent=1)
    before = _seals(place)
    _seal(place, [*before, _digest(data)])  # either counts until the file is there
    OWN_LAB.put(OWN_LAB.path(place.folder), data)
    _seal(place, [_digest(data)])


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _require_sealed(place: BenchPlace, path: Path, data: bytes | None) -> None:
    """Raise PicoError where a Lab is not the one that the bench wrote, or is gone while its journal is there: a whole
    bench may be thrown away. Outside Git nothing tells."""
    sealed = _seals(place)
    if not sealed or (data is not None and _digest(data) in sealed):
        return
    if data is None and not path.with_name("journal.sqlite").exists():
        return
    if data is not None:
        OWN_LAB.made(path, data, _own_lab)  # damaged, which is not what a commit brings
    how = "is gone" if data is None else "is not what the bench wrote there: a commit may have brought it"
    raise PicoError(error(CODE, f"{path} {how}, so nobody knows what this bench is", hint=_HINT))


def is_sealed(place: BenchPlace) -> bool:
    """Return whether Git's folder knows what the bench at `place` keeps; outside Git there is nothing to."""
    return bool(_seals(place)) or lab_place(place.root) is None


def _seals(place: BenchPlace) -> list[str]:
    lab = lab_place(place.root)
    found = sealed_labs(lab).get(lab.inside, {}) if lab else {}
    return found.get(place.name, found.get(SHARED, []))


def _seal(place: BenchPlace, digests: Sequence[str]) -> None:
    lab = lab_place(place.root)
    if lab is not None:
        known = sealed_labs(lab)
        write_seals(lab, {**known, lab.inside: {**known.get(lab.inside, {}), place.name: list(digests)}})


def proposed(root: Path) -> OwnLab:
    """Return the Lab that the files in the working tree describe; raises PicoError for files that can't be read."""
    files, wrong = read_folder(root)
    if unread := [d for d in wrong if d.severity == "error"]:
        raise PicoError(unread)
    return of_files(bench_files(files, shown_path(root)))


def of_files(files: Mapping[str, bytes]) -> OwnLab:
    """Return the Lab that files describe, by path in the lab's folder."""
    return OwnLab(files={name: data.decode("utf-8", "surrogateescape") for name, data in files.items()})


def setup_of(lab: OwnLab) -> Setup:
    """Return the bench that a Lab describes; raises PicoError for what is wrong with it."""
    from pico.manifest.checks.required_version import require_satisfied
    from pico.manifest.load import load_files

    before = NAMED if lab.at else ""
    read = load_files({before + name: data for name, data in lab.as_bytes().items()})
    require_satisfied(read.diagnostics)
    wrong = [d for d in read.diagnostics if d.severity == "error" and d.code != "no-state"]
    if read.setup is None or wrong:
        kept = error(CODE, "what the bench keeps as its own Lab can't be used", hint=_HINT)
        raise PicoError([kept, *(wrong or read.diagnostics)] if lab.at else wrong or read.diagnostics)
    return read.setup
