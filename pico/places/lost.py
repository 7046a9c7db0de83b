"""A bench that Git's own folder knows, and whose folder is gone: by `git clean -fdx`, with a worktree that was deleted,
or since the lab or its worktree was moved.

What PICO knew of it alone is gone with it: runs that no commit has, the bench's own Lab, what hands hold. So that is
said before anything moves, and a person decides.
"""

from __future__ import annotations

import os
from pathlib import Path

from pico.base.state_files import CHOSEN, JOURNAL, LOCK, OWN_LAB, WORLD
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.places.bench import BenchPlace
from pico.places.lab import BENCHES, FOLDER, LabPlace, lab_place
from pico.places.record import SHARED, Record, is_of, read_record, worktrees
from pico.places.seals import sealed_labs

_TELLING = tuple(file.name for file in (LOCK, JOURNAL, WORLD, OWN_LAB))
"""Files of which a bench that was ever used has at least one."""


def lost_bench(bench: BenchPlace) -> Diagnostic | None:
    """Return that what was kept of a bench is gone, or stayed behind, and what to do; None if it is there, or if it was
    never used. Raises PicoError as `BenchPlace.folder` does."""
    lab = lab_place(bench.root)
    if lab is None:
        return None
    record = read_record(lab)
    known = record.get(lab.inside, {})
    there = known.get(bench.name, known.get(SHARED))
    if there is not None and (other := Path(os.path.normpath(lab.common / there))) != lab.root:
        return None if is_of(other, lab) else _unattached(bench, other, moved_to(lab, bench.name))
    if any((bench.own / name).exists() for name in _TELLING):
        return None
    if there is not None or bench.name in sealed_labs(lab).get(lab.inside, {}):
        return _gone(bench)
    left = _left_behind(bench, lab, record)
    return None if left is None else _stayed(bench, left)


def moved_to(lab: LabPlace, name: str) -> Path | None:
    """Return the folder of the lab that has what was kept of a bench whose worktree is gone: `git worktree move` takes
    it along. None if no worktree has it, or several may."""
    names = [file.name for file in (JOURNAL, WORLD, OWN_LAB)]
    found = [root for root in worktrees(lab) if any((root / FOLDER / BENCHES / name / file).exists() for file in names)]
    return found[0] if len(found) == 1 else None


def others_lost(bench: BenchPlace) -> tuple[Diagnostic, ...]:
    """Return what was lost of other benches of this worktree, if it also lost which bench its commands mean: they may
    have meant another one than `bench`."""
    lab = lab_place(bench.root)
    if lab is None or CHOSEN.path(bench.root / FOLDER).exists():
        return ()
    names = sorted(name for name in read_record(lab).get(lab.inside, {}) if name not in (SHARED, bench.name))
    lost = [
        name for name in names if (found := lost_bench(BenchPlace(bench.root, name))) and found.code == "lost-bench"
    ]
    text = "what PICO kept of the bench `{0}` is gone, too, and with it which bench commands mean: this one means `{1}`"
    hint = "`pico bench use {0}` chooses it again"
    return tuple(error("lost-bench", text.format(name, bench.name), hint=hint.format(name)) for name in lost)


def refusal(place: object) -> PicoError | None:
    """Return the error (exit code LOCKED) that the folder of `place`, a bench of this machine, is gone: what it shows
    then is where parts begin, not where they stand. None if it is there."""
    lost = lost_bench(place) if isinstance(place, BenchPlace) else None
    return None if lost is None else PicoError(lost, ExitCode.LOCKED)


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


def _unattached(bench: BenchPlace, there: Path, moved: Path | None) -> Diagnostic:
    command = f"pico --bench {bench.name} git attach"
    text = f"the bench `{bench.name}` was attached to {there}, which is gone"
    if moved is None:
        hint = f"`{command}` takes it: every part then stands at home"
        return error("not-attached", f"{text}, with its state and journal", hint=hint)
    text = f"{text}; its state and journal are in {moved / FOLDER / BENCHES / bench.name}"
    return error("not-attached", text, hint=f"`{command}` continues with them")


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
