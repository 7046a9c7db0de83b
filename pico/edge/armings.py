"""The armings that a bench keeps: a file for each laser in `armed` beside its own Lab, written whole or not at all.

A file for each, so that two who write at once never bring back what the other took away. One that is broken, or that
the bench did not write (a checkout may bring one), arms nothing. What a bench wrote it knows again by its SHA-256 in
Git's own folder; outside Git nothing tells.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from pico.base.plain_files import read_file, read_text, remove_file
from pico.base.state_files import ARMED, ARMED_SEAL
from pico.model.arming import Arming
from pico.model.record import as_json, record
from pico.places.bench import BenchPlace
from pico.places.lab import lab_place
from pico.places.old_records import seal_of_arming

FOLDER = "armed"


@record
class Kept:
    """What a bench keeps of a laser: an arming, or why its file (`broken`) is none."""

    laser: str
    arming: Arming | None = None
    broken: str = ""


def kept(place: BenchPlace) -> tuple[Kept, ...]:
    """Return what the bench at `place` keeps, by laser. Never raises for what lies there."""
    folder = place.folder / FOLDER
    try:
        paths = sorted(folder.glob("*.json"))
    except OSError:
        return ()
    return tuple(_read(place, path) for path in paths)


def keep(place: BenchPlace, arming: Arming) -> None:
    """Let the bench keep an arming, in the place of an earlier one of its laser; raises PicoError."""
    data = ARMED.dump(as_json(arming), indent=1)
    if seal := _seal(place, arming.laser):
        ARMED_SEAL.put(seal, (_digest(data) + "\n").encode())
    ARMED.put(place.folder / FOLDER / f"{arming.laser}.json", data)


def forget(place: BenchPlace, laser: str) -> None:
    """Let the bench keep nothing of a laser any more."""
    remove_file(place.folder / FOLDER / f"{laser}.json")
    if seal := _seal(place, laser):
        remove_file(seal)


def _read(place: BenchPlace, path: Path) -> Kept:
    laser = path.stem
    try:
        if path.is_symlink() or path.parent.is_symlink():
            return Kept(laser=laser, broken="it is a link")
        data = read_file(path)
        seal = _seal(place, laser)
        if seal is not None and read_text(seal, "ascii").strip() != _digest(data):
            return Kept(laser=laser, broken="it is not what the bench wrote there")
        arming = _arming(ARMED.parse(data))
        return (
            Kept(laser=laser, arming=arming) if arming.laser == laser else Kept(laser=laser, broken="of another laser")
        )
    except Exception as exc:  # whatever lies there, it arms nothing, and keeps nobody from shutting the laser
        return Kept(laser=laser, broken=f"{type(exc).__name__}: {str(exc)[:80]}")


def _arming(document: object) -> Arming:
    from pydantic import TypeAdapter

    found: Arming = TypeAdapter(Arming).validate_python(document)
    return found


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _seal(place: BenchPlace, laser: str) -> Path | None:
    """Return the file in Git's folder, which all worktrees share, that knows what the bench wrote; None outside Git."""
    lab = lab_place(place.root)
    return seal_of_arming(lab, place.name, laser) if lab else None
