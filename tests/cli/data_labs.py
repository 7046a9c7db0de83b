"""Labs whose runs have large data."""

from __future__ import annotations

import hashlib
import json
import subprocess
from pathlib import Path

from pico.history.data.lab import LabData


def git(*words: str, at: Path | str = ".") -> str:
    """Run git and return what it says."""
    done = subprocess.run(["git", *words], cwd=at, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def put(folder: Path, data: bytes) -> str:
    """Keep an object in the store of a lab and return its name."""
    return LabData.discover(folder).store.put(data)


def write_run(folder: Path, run: str, *objects: bytes) -> str:
    """Keep objects and write a run that needs them, as a recorder does; return the name of the last object."""
    names = [put(folder, data) for data in objects]
    pairs = enumerate(zip(names, objects, strict=True))
    artifacts = [{"name": f"frame{i}.bin", "sha256": name, "size": len(data)} for i, (name, data) in pairs]
    path = folder / "runs" / "2026" / "11" / run / "run.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps({"schema": "pico.run/v1", "id": run, "artifacts": artifacts}))
    return names[-1]


def commit_run(folder: Path, run: str, *objects: bytes) -> str:
    """Write a run as `write_run` does, and commit it."""
    name = write_run(folder, run, *objects)
    git("add", "runs", at=folder)
    git("commit", "-q", "-m", run, at=folder)
    return name


def damage(path: Path) -> None:
    """Change the first byte of an object, as a dying disk does."""
    path.chmod(0o644)
    path.write_bytes(b"X" + path.read_bytes()[1:])


def sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
