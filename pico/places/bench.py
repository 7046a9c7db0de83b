"""One bench of a lab on this machine, and the folder in which all that PICO keeps of it lies.

A bench is the simulated table (`sim`), the emulated one, the real one (`hardware`), or that of a plug-in's device. Each
has a journal, a lock, a Lab and a memory of its own, in `.pico/benches/NAME` of the worktree that is attached to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pico.places.lab import BENCHES, FOLDER, lab_place, own_names, refuse_links
from pico.places.layout import OLD
from pico.places.record import attached

_held: dict[BenchPlace, Path] = {}


@dataclass(frozen=True)
class BenchPlace:
    """The bench called `name` of the lab in folder `root`; `name` is that of its device."""

    root: Path
    name: str

    @property
    def folder(self) -> Path:
        """Where the bench is kept: in `.pico` of the worktree that is attached to it.

        Raises PicoError for a symbolic link, for PICO writes there.
        """
        if (held := _held.get(self)) is not None:
            return held
        return self.attached.own

    @property
    def attached(self) -> BenchPlace:
        """The same bench as seen from the worktree that is attached to it; this one if none is."""
        lab = lab_place(self.root)
        there = attached(lab, self.name) if lab else None
        return self if there is None else BenchPlace(there, self.name)

    @property
    def own(self) -> Path:
        """Where the bench is kept while this worktree is attached to it. Raises PicoError as `folder` does."""
        return folder_in(self.root, self.name)

    @property
    def said(self) -> str:
        """What the bench is called in messages."""
        return self.name

    @property
    def title(self) -> str:
        """What runs and commits call the bench."""
        return self.name


def local_benches(root: Path) -> tuple[BenchPlace, ...]:
    """Return the benches of this machine that this worktree of the lab in `root` keeps; raises PicoError."""
    try:
        _split_if_old(root, own_names(root))
        folders = sorted((root / FOLDER / BENCHES).iterdir())
    except OSError:
        return ()  # below the folder of a coordinator are the labs that it has, and no files
    return tuple(
        BenchPlace(root, one.name) for one in folders if one.is_dir() and any(path.is_file() for path in one.iterdir())
    )


def folder_in(root: Path, name: str) -> Path:
    """Return where the worktree of the lab in `root` keeps the bench `name`; what an earlier PICO kept in one folder
    for all benches is split first. Raises PicoError for a symbolic link, and if that can't be split."""
    names, benches = own_names(root), root / FOLDER / BENCHES
    refuse_links(benches)
    _split_if_old(root, names)
    refuse_links(benches / name)
    return benches / name


def _split_if_old(root: Path, names: frozenset[str]) -> None:
    if names & OLD:
        from pico.places.splitting import split_layout

        split_layout(root)


def hold(bench: BenchPlace) -> None:
    """Fix the folder of a bench until `let_go`: while this process has the bench locked, it need not be looked up
    again, since no other process can attach it to another worktree. Raises PicoError as `BenchPlace.folder` does."""
    _held[bench] = bench.folder


def let_go(bench: BenchPlace) -> None:
    """Look up the folder of a bench again each time, see `hold`."""
    _held.pop(bench, None)
