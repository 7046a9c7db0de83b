"""A bench that Git's own folder knows, and whose folder is gone: by `git clean -fdx`, or since the lab was moved.

What PICO knew of it alone is gone with it: runs that no commit has, the bench's own Lab, what hands hold. So that is
said before anything moves, and a person decides.
"""

from __future__ import annotations

import os
from pathlib import Path

from pico.base.state_files import JOURNAL, LOCK, OWN_LAB, WORLD
from pico.diagnostics import Diagnostic, error
from pico.places.bench import BenchPlace
from pico.places.lab import BENCHES, FOLDER, LabPlace, lab_place
from pico.places.record import SHARED, Record, read_record
from pico.places.seals import sealed_labs

_TELLING = tuple(file.name for file in (LOCK, JOURNAL, WORLD, OWN_LAB))
"""Files of which a bench that was ever used has at least one."""


def lost_bench(bench: BenchPlace) -> Diagnostic | None:
    """Return that what was kept of a bench is gone, or stayed behind, and what to do; None if it is there, or if it was
    never used. Raises PicoError as `BenchPlace.folder` does."""
    lab = lab_place(bench.root)
    if lab is None or any((bench.own / name).exists() for name in _TELLING):
        return None
    record = read_record(lab)
    known = record.get(lab.inside, {})
    there = known.get(bench.name, known.get(SHARED))
    if there is not None and os.path.normpath(lab.common / there) != str(lab.root):
        return None  # it is another worktree's
    if there is not None or bench.name in sealed_labs(lab).get(lab.inside, {}):
        return _gone(bench)
    left = _left_behind(bench, lab, record)
    return None if left is None else _stayed(bench, left)


def _left_behind(bench: BenchPlace, lab: LabPlace, record: Record) -> Path | None:
    """Return the folder that was a lab of this worktree, is none any more, and still has a bench of this name."""
    for inside, known in record.items():
        there = known.get(bench.name)
        folder = Path(os.path.normpath(lab.common / there)) if there and inside != lab.inside else None
        if folder is None or not folder.is_relative_to(lab.top) or any(folder.glob("*.yaml")):
            continue
        if (folder / FOLDER / BENCHES / bench.name).is_dir():
            return folder
    return None


def _gone(bench: BenchPlace) -> Diagnostic:
    text = (
        f"what PICO kept of the bench `{bench.name}` is gone: {bench.own} (`git clean -fdx` deletes it). Lost are the "
        "runs that no commit has, the bench's own Lab, and what hands hold"
    )
    stands = "every part then counts as at home" if bench.name == "sim" else "look at the table before anything moves"
    hint = f"put the folder back from a copy, or start anew with `pico --bench {bench.name} git attach`: {stands}"
    return error("lost-bench", text, hint=hint)


def _stayed(bench: BenchPlace, left: Path) -> Diagnostic:
    text = f"what PICO kept of the bench `{bench.name}` stayed in {left / FOLDER} when this lab was moved here"
    move = f"mkdir -p {bench.root / FOLDER} && mv {left / FOLDER / BENCHES} {bench.root / FOLDER}/"
    hint = f"`{move}` brings it along; `pico --bench {bench.name} git attach` starts anew"
    return error("lost-bench", text, hint=hint)
