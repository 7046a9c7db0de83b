"""Which worktree has a bench: one is attached to it, the others of the same repository only look and plan.

What PICO keeps of a bench is in `.pico` beside the manifests of the worktree that is attached to it; one worktree may
have the real bench while another one simulates. The first that moves a bench is attached to it; `attach` takes it to
another worktree. Separate clones and labs outside Git have benches of their own.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.disk import writing
from pico.places.bench import BenchPlace, folder_in
from pico.places.lab import lab_place, make_own_folder
from pico.places.lost import moved_to, refusal
from pico.places.record import is_of, note, recorded, recording

_STAYS = ("holder.json", "incoming", "replaced")
"""What is not the bench: who has it locked, and what `_bring` makes."""


def require_attached(bench: BenchPlace) -> None:
    """Attach the worktree of the lab to its bench if none is; raises PicoError (exit code LOCKED) if another one is.
    Call it with the bench locked, before something moves."""
    place = lab_place(bench.root)
    if place is None or not any(bench.root.glob("*.yaml")):  # a scratch folder is no lab
        return
    with recording(place) as record:
        there = recorded(place, record, bench.name)
        if lost := refusal(bench):
            raise lost
        if there is None:
            _begin(bench)  # first: a bench that the record knows, and that is not there, was lost
            note(place, record, bench.name)
        elif there != place.root:
            raise PicoError(_elsewhere(bench, there), ExitCode.LOCKED)


def attach(bench: BenchPlace) -> Path | None:
    """Attach the worktree of a lab to a bench, which moves there with its simulated table and journal.

    Call it with the bench locked where it was. Returns the folder of the lab that had it until now, or to which that
    was moved; None if there was none, or if that is gone with all that it kept. Raises PicoError outside a repository,
    and if files can't be moved.
    """
    place = lab_place(bench.root)
    if place is None:
        hint = "outside Git each folder has benches of its own"
        text = f"{bench.root} is in no Git repository, so there is nothing to attach"
        raise PicoError(error("git-none", text, hint=hint))
    with recording(place) as record:
        before = recorded(place, record, bench.name)
        if before is not None and not is_of(before, place):
            before = moved_to(place, bench.name)
        there = before if before != place.root else None
        if there is not None:
            _bring(folder_in(there, bench.name), folder_in(place.root, bench.name))
        else:
            _begin(bench)
        note(place, record, bench.name)
    if there is not None:
        _clear(folder_in(there, bench.name))
    return there


def _begin(bench: BenchPlace) -> None:
    """Let a bench have a folder with its lock, as one that was used."""
    with writing(bench.own, code="folder"):
        make_own_folder(bench.root)
        bench.own.mkdir(parents=True, exist_ok=True)
        (bench.own / "lock").touch()


def _bring(there: Path, here: Path) -> None:
    """Copy what one worktree keeps of a bench into another one; whole, or its own stays."""
    incoming = here / "incoming"
    try:
        shutil.rmtree(incoming, ignore_errors=True)
        here.mkdir(parents=True, exist_ok=True)
        skipped = shutil.ignore_patterns(*_STAYS)
        shutil.copytree(there, incoming, ignore=skipped, symlinks=True)
        _set_aside(here)
        for new in sorted(incoming.iterdir()):
            new.replace(here / new.name)
        incoming.rmdir()
    except (OSError, shutil.Error) as exc:
        text = f"the bench in {there} could not be brought to {here}: {exc}"
        raise PicoError(error("attach", text, hint="it is attached to the worktree where it was")) from exc


def _set_aside(here: Path) -> None:
    """Keep what a worktree had of a bench of its own before, in `replaced`, which PICO does not read."""
    if old := _contents(here):
        shutil.rmtree(here / "replaced", ignore_errors=True)
        (here / "replaced").mkdir()
        for path in old:
            path.replace(here / "replaced" / path.name)


def _clear(folder: Path) -> None:
    """Take away what was brought elsewhere; what stays is not read any more."""
    for old in _contents(folder):
        if old.is_dir() and not old.is_symlink():
            shutil.rmtree(old, ignore_errors=True)
        else:
            old.unlink(missing_ok=True)


def _contents(folder: Path) -> list[Path]:
    return [path for path in folder.iterdir() if path.name not in _STAYS] if folder.is_dir() else []


def _elsewhere(bench: BenchPlace, there: Path) -> Diagnostic:
    hint = f"work there (`pico -C {there} ...`), or bring the bench here: `pico git attach`; looking is always possible"
    text = f"this worktree only plans on `{bench.name}`: that bench is attached to {there}"
    return error("not-attached", text, hint=hint)
