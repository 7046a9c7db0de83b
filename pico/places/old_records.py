"""What Git's own folder knows of the benches of a lab, lifted when one folder was split into one for each bench."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

from pico.places.lab import LabPlace, lab_place
from pico.places.record import SHARED, recording
from pico.places.seals import sealed_labs, write_seals

T = TypeVar("T")
ARMED = "armed"
"""The folder for the seals of armings."""


def lift_records(root: Path, benches: Sequence[str]) -> None:
    """Let each bench of the lab in `root` be attached where all were, and have the seals of all. It may be called
    again. Raises PicoError, OSError."""
    lab = lab_place(root)
    if lab is None:
        return
    with recording(lab) as record:
        known = record.get(lab.inside, {})
        there = known.get(SHARED)
        if there is not None and os.path.normpath(lab.common / there) == str(lab.root):
            record[lab.inside] = {**dict.fromkeys(benches, there), **_without(known, SHARED)}
    seals = sealed_labs(lab)
    if (old := seals.get(lab.inside, {}).get(SHARED)) is not None:
        own = {**dict.fromkeys(benches, old), **_without(seals[lab.inside], SHARED)}
        write_seals(lab, {**seals, lab.inside: own})
    for bench in benches:
        for arming in (root / ".pico" / "benches" / bench / ARMED).glob("*.json"):
            _lift_arming(lab, bench, arming.stem)


def seal_of_arming(lab: LabPlace, bench: str, laser: str) -> Path:
    """Return the file in Git's folder that knows what a bench wrote of an arming."""
    return lab.common / "pico" / ARMED / _name(f"{lab.inside}/{bench}/{laser}")


def _lift_arming(lab: LabPlace, bench: str, laser: str) -> None:
    old, new = lab.common / "pico" / ARMED / _name(f"{lab.inside}/{laser}"), seal_of_arming(lab, bench, laser)
    if old.is_file() and not new.exists():
        shutil.copy2(old, new)


def _name(words: str) -> str:
    return hashlib.sha256(words.encode()).hexdigest()[:32]


def _without(found: dict[str, T], name: str) -> dict[str, T]:
    return {key: value for key, value in found.items() if key != name}
