"""The armings that a bench keeps: a file for each laser in `armed` beside its own Lab, written whole or not at all.

A file for each, so that two who write at once never bring back what the other took away. One that is broken, or that
the bench did not write (a checkout may bring one), arms nothing. What a bench wrote it knows again by its SHA-256 in
Git's own folder; outside Git nothing tells.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from pico.attachment import bench_folder, lab_place
from pico.disk import write_whole
from pico.model.arming import FORMAT, Arming
from pico.model.record import as_json, record

FOLDER = "armed"


@record
class Kept:
    """What a bench keeps of a laser: an arming, or why its file (`broken`) is none."""

    laser: str
    arming: Arming | None = None
    broken: str = ""


def kept(root: Path) -> tuple[Kept, ...]:
    """Return what the bench of the lab in `root` keeps, by laser. Never raises for what lies there."""
    folder = bench_folder(root) / FOLDER
    try:
        paths = sorted(folder.glob("*.json"))
    except OSError:
        return ()
    return tuple(_read(root, path) for path in paths)


def keep(root: Path, arming: Arming) -> None:
    """Let the bench keep an arming, in the place of an earlier one of its laser; raises PicoError."""
    data = (json.dumps(as_json(arming), indent=1) + "\n").encode()
    if seal := _seal(root, arming.laser):
        write_whole(seal, (_digest(data) + "\n").encode(), folders=True)
    write_whole(bench_folder(root) / FOLDER / f"{arming.laser}.json", data, folders=True)


def forget(root: Path, laser: str) -> None:
    """Let the bench keep nothing of a laser any more."""
    (bench_folder(root) / FOLDER / f"{laser}.json").unlink(missing_ok=True)
    if seal := _seal(root, laser):
        seal.unlink(missing_ok=True)


def _read(root: Path, path: Path) -> Kept:
    laser = path.stem
    try:
        if path.is_symlink() or path.parent.is_symlink():
            return Kept(laser=laser, broken="it is a link")
        data = path.read_bytes()
        seal = _seal(root, laser)
        if seal is not None and seal.read_text(encoding="ascii").strip() != _digest(data):
            return Kept(laser=laser, broken="it is not what the bench wrote there")
        arming = _arming(json.loads(data))
        return (
            Kept(laser=laser, arming=arming) if arming.laser == laser else Kept(laser=laser, broken="of another laser")
        )
    except Exception as exc:  # whatever lies there, it arms nothing, and keeps nobody from shutting the laser
        return Kept(laser=laser, broken=f"{type(exc).__name__}: {str(exc)[:80]}")


def _arming(document: object) -> Arming:
    from pydantic import TypeAdapter

    found: Arming = TypeAdapter(Arming).validate_python(FORMAT.lifted(document))
    return found


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _seal(root: Path, laser: str) -> Path | None:
    """Return the file in Git's folder, which all worktrees share, that knows what the bench wrote; None outside Git."""
    place = lab_place(root)
    name = _digest(f"{place.inside}/{laser}".encode())[:32] if place else ""
    return place.common / "pico" / FOLDER / name if place else None
