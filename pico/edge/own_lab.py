"""The Lab that a bench itself keeps, with its component types: plan and apply go by it, whatever the working tree says.

It is `lab.json` beside the journal: the manifest files that describe the bench, as text. The edge writes it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pico.attachment import bench_folder
from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.edge.protocol import OwnLab
from pico.manifest.files import bench_files, read_folder, shown_path

if TYPE_CHECKING:
    from pico.model.lab import Setup

FILE = "lab.json"
SCHEMA = "pico.bench-lab/v1"
NAMED = "the bench's own "
"""What stands before the names of its files in diagnostics."""
_HINT = f"delete `.pico/{FILE}`, and the bench adopts what the working tree describes the next time that it moves"


def read(root: Path) -> OwnLab | None:
    """Return the Lab that the bench of the lab in `root` keeps, None where it keeps none yet; raises PicoError."""
    path = bench_folder(root) / FILE
    try:
        document = json.loads(path.read_bytes())
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as exc:
        raise PicoError(error("bench-lab", f"{path} can't be read: {exc}", hint=_HINT)) from exc
    try:
        if document["schema"] != SCHEMA:
            text = f"{path} is {str(document['schema'])[:40]}, and this PICO reads {SCHEMA}"
            raise PicoError(error("bench-lab", text, hint="update PICO"))
        files = {str(name): str(text) for name, text in document["files"].items()}
        return OwnLab(files=files, by=str(document["by"]), at=str(document["at"]))
    except (KeyError, TypeError, AttributeError) as exc:
        raise PicoError(error("bench-lab", f"{path} is no Lab of a bench", hint=_HINT)) from exc


def write(root: Path, lab: OwnLab) -> None:
    """Let the bench of the lab in `root` keep a Lab, whole or not at all; raises PicoError."""
    document = {"schema": SCHEMA, "by": lab.by, "at": lab.at, "files": dict(lab.files)}
    path = bench_folder(root) / FILE
    write_whole(path, (json.dumps(document, indent=1) + "\n").encode())


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
    from pico.manifest.load import load_files

    before = NAMED if lab.at else ""
    read = load_files({before + name: data for name, data in lab.as_bytes().items()})
    wrong = [d for d in read.diagnostics if d.severity == "error" and d.code != "no-state"]
    if read.setup is None or wrong:
        kept = error("bench-lab", "what the bench keeps as its own Lab can't be used", hint=_HINT)
        raise PicoError([kept, *(wrong or read.diagnostics)] if lab.at else wrong or read.diagnostics)
    return read.setup
