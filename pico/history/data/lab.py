"""The data of one lab, as the command line and scripts use it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pico.content.store import store_in
from pico.diagnostics import PicoError, error
from pico.history.data.needs import Needs, kept_needs, needs
from pico.history.data.places import SETTING, CopyPlace, configured, place_of
from pico.history.data.pointers import Pointed, write_pointers
from pico.history.data.transfer import Holdings, Moved, Shared, holdings, pull, push
from pico.history.data.upkeep import Garbage, StoreCheck, check, garbage, remove
from pico.history.repository.repository import Repository

GRACE = 14 * 86400.0
"""Seconds for which what nothing needs is kept: a run that is recorded right now has no commit yet."""


def _quiet(_: float) -> None:
    pass


class LabData:
    """The store that the worktrees of a repository share, and the place that keeps copies. Methods raise PicoError.

    `place`: a folder, an URL or `lfs`, instead of the one that `git config pico.data.remote` names. `shared` hears how
    far it is.
    """

    def __init__(self, repository: Repository) -> None:
        self.repository = repository
        self.store = store_in(repository.common)

    @classmethod
    def discover(cls, path: Path) -> LabData:
        """Return the data of the repository that `path` lies in; its manifests may be wrong."""
        repository = Repository.discover(path)
        if repository is None:
            hint = "`git init` makes one; the data of runs belongs to their commits"
            raise PicoError(error("git-none", f"{path.resolve()} is in no Git repository", hint=hint))
        return cls(repository)

    def has_place(self) -> bool:
        """Return whether the configuration says where copies are kept."""
        return bool(configured(self.repository))

    def needs(self) -> Needs:
        """Return what the runs in the commits of every ref need."""
        return needs(self.repository)

    def status(self, place: str | None = None) -> Holdings:
        """Return what is needed, here and there."""
        return holdings(self.store, place_of(self.repository, place), self.needs())

    def push(self, place: str | None = None, shared: Shared = _quiet) -> Moved:
        """Copy to the place what is needed, here and not there; call it again after a break, it goes on."""
        return push(self.store, self._place(place), self.needs(), shared)

    def pull(self, place: str | None = None, shared: Shared = _quiet) -> Moved:
        """Copy from the place what is needed and not here."""
        return pull(self.store, self._place(place), self.needs(), shared)

    def check(self, shared: Shared = _quiet) -> StoreCheck:
        """Read every object again, set aside what is damaged, and return what is wrong."""
        return check(self.store, self.needs(), shared)

    def garbage(self, grace: float = GRACE) -> Garbage:
        """Return what nothing here needs: no run of any ref, reflog, index, working tree or journal."""
        return garbage(self.store, kept_needs(self.repository), grace)

    def remove(self, found: Garbage, grace: float = GRACE) -> int:
        """Remove what `garbage` found, except what is needed by now; return the bytes that this freed."""
        return remove(self.store, found, kept_needs(self.repository), grace)

    def point(self, lab: Path, runs: Sequence[str] = ()) -> Pointed:
        """Write Git LFS pointers beside the runs of a lab, for a commit; see `write_pointers`."""
        return write_pointers(self.repository, lab, self.store, runs)

    def _place(self, word: str | None) -> CopyPlace:
        found = place_of(self.repository, word)
        if found is None:
            hint = f"name a folder, or set one for good: `git config {SETTING} FOLDER`"
            raise PicoError(error("data-place", "nothing says where the data of this lab is kept", hint=hint))
        return found
