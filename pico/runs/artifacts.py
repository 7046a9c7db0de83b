"""Where the artifacts of a run lie, where they lie beside it: in a crate, or as pointers of Git LFS."""

from __future__ import annotations

import re

from pico.model.trace.run import Artifact, Run
from pico.runs.files import run_folder

_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")


def artifact_paths(run: Run) -> dict[str, Artifact]:
    """Return the artifacts of a run by path relative to the lab, under names that are nothing but names.

    Two of one name are told apart by the beginnings of their hashes.
    """
    found: dict[str, Artifact] = {}
    for artifact in run.artifacts:
        name = _UNSAFE.sub("_", artifact.name).lstrip(".") or "artifact"
        path = f"{run_folder(run)}/artifacts/{name}"
        found[path if path not in found else f"{run_folder(run)}/artifacts/{artifact.sha256[:12]}-{name}"] = artifact
    return found
