"""The files of runs on their way into a commit: written once, never over another file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from pico.diagnostics import PicoError, error
from pico.history.lab.files import write_file
from pico.history.messages.trailers import PLAN, RUN, Trailers

RUNS = "runs"


def write_once(root: Path, name: str, data: bytes) -> Path:
    """Write a file of a run below the lab's folder `root`, whole or not at all, and return its path.

    One that holds the same already is left as it is. Raises PicoError where another file stands there, where `name` is
    not below `runs/`, and where the folder can't be written.
    """
    path = root / name
    if PurePosixPath(name).parts[:1] != (RUNS,) or not path.resolve().is_relative_to(root.resolve() / RUNS):
        raise PicoError(error("outside", f"{path} is no place for a file of a run", hint=f"they are in {root / RUNS}"))
    try:
        if path.is_symlink() or path.exists():
            if path.is_file() and not path.is_symlink() and path.read_bytes() == data:
                return path
            hint = "a run is written once; where no commit has this file, delete it and commit again"
            raise PicoError(error("run-exists", f"{path} exists, and says something else", hint=hint))
        write_file(path, data, root / ".pico")
    except OSError as exc:
        raise PicoError(error("folder", f"can't write {path}: {exc.strerror or exc}")) from exc
    return path


def run_trailers(runs: Mapping[str, bytes]) -> Trailers:
    """Return which runs some files belong to, and of which plans those were, as trailers."""
    documents = {PurePosixPath(p).parent.name: data for p, data in sorted(runs.items()) if p.endswith("/run.json")}
    plans = dict.fromkeys(plan for data in documents.values() if (plan := _plan(data)))
    return (*((RUN, run) for run in documents), *((PLAN, plan) for plan in plans))


def _plan(data: bytes) -> str:
    try:
        document = json.loads(data)
    except ValueError:
        return ""
    plan = document.get("plan") if isinstance(document, dict) else None
    return plan if isinstance(plan, str) and plan.isprintable() else ""
