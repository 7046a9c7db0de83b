"""What a bench offers that asks no backend: its manifests and their history. Both faces of a bench share it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.history.lab.folder import CommitEntry, LabFolder
from pico.history.lab.notes import Note
from pico.model.diff import Change
from pico.model.lab import Setup
from pico.model.plan import Plan, plan_from_json
from pico.model.state import LabState

if TYPE_CHECKING:
    from pico.history.blame.blamed import Blamed
    from pico.history.diff.states import StateDiff
    from pico.history.log import Log
    from pico.history.shown import Shown


class Reader:
    """Reads the lab's folder, and states at revisions, for the class that has one as `folder`."""

    folder: LabFolder

    @property
    def root(self) -> Path:
        """The lab's folder."""
        return self.folder.root

    @property
    def setup(self) -> Setup:
        """The bench as it is now: lab and component types."""
        return self.folder.setup

    @property
    def state(self) -> LabState:
        """The desired state: what the manifests in the working tree say."""
        return self.folder.state

    def state_at(self, revision: str) -> LabState:
        """Return the state that a revision holds; raises PicoError."""
        return self.folder.state_at(revision)

    def diff(self, a: str | None = None, b: str | None = None) -> tuple[Change, ...]:
        """Return what differs from revision `a` (HEAD) to `b` (the working tree), exactly; raises PicoError."""
        return self.folder.diff(a, b)

    def compare(
        self, a: str | None = None, b: str | None = None, names: Sequence[str] = (), *, at: Path | None = None
    ) -> StateDiff:
        """Return all that differs from revision `a` (HEAD; it may be a range) to `b` (the working tree).

        `names`: of these components and files alone, paths relative to `at` (the lab). Raises PicoError.
        """
        from pico.history.diff.states import compare
        from pico.history.lab.scope import read_scope

        scope = read_scope(self.folder, names, at or self.root, past=True)
        return compare(self.folder, a, b, scope)

    def log(
        self,
        *revisions: str,
        every: bool = False,
        limit: int | None = None,
        names: Sequence[str] = (),
        at: Path | None = None,
        options: Sequence[str] = (),
        graph: bool = False,
    ) -> Log:
        """Return the commits that changed the lab, newest first, with their physical diffs; see `pico.history.log`.

        `revisions`: also ranges, HEAD for none. `names`: only those that changed these components or files, paths
        relative to `at` (the lab). `options` are those of `git rev-list`. Raises PicoError, also while it is read.
        """
        from pico.history.lab.scope import read_scope
        from pico.history.log import Log, LogRequest

        scope = read_scope(self.folder, names, at or self.root, past=True)
        asked = LogRequest(
            revisions=revisions, every=every, options=tuple(options), limit=limit, scope=scope, topological=graph
        )
        return Log(self.folder, asked)

    def blame(self, *what: str, at: str | None = None, history: bool = False) -> Blamed:
        """Return who last changed these components and tunables, all for none; see `pico.history.blame.blamed`."""
        from pico.history.blame.blamed import blame

        return blame(self.root, what, at=at, history=history)

    def show(self, what: str = "HEAD") -> Shown:
        """Return what a revision, or `REV:COMPONENT`, did and holds; see `pico.history.shown`. Raises PicoError."""
        from pico.history.shown import show

        return show(self.folder, what)

    def entry(self, revision: str) -> CommitEntry:
        """Return the commit that a revision names, with its physical diff; raises PicoError."""
        return self.folder.entry(self.folder.history().resolve(revision))

    def notes(self, part: str) -> tuple[Note, ...]:
        """Return what people noted on a part, oldest first; raises PicoError where there is no such part."""
        return self.folder.notes(part)

    def note(self, part: str, text: str) -> Note:
        """Note something on a part, for the next commit to take along; raises PicoError."""
        return self.folder.note(part, text)

    def head_name(self) -> str:
        """Return what is checked out as a person calls it; empty without Git."""
        head = self.folder.head()
        return head.label if head else ""

    def here(self) -> str:
        """Return what to check out to come back to what is checked out now: the branch, else the commit's short id."""
        head = self.folder.head()
        return (head.branch or (head.commit or "")[:7]) if head else ""

    def head_commit(self) -> str | None:
        """Return the id of the commit checked out; None without Git or before the first commit."""
        head = self.folder.head()
        return head.commit if head else None

    def name_of(self, revision: str) -> str:
        """Return `e1 (E1-3 "p2 tilted")` for a revision; raises PicoError."""
        commit = self.folder.history().resolve(revision)
        label = commit.label if revision in ("HEAD", commit.id) else revision
        known = "" if label == commit.label else f"{commit.label} "
        return f'{label} ({known}"{commit.summary}")' if known else f'{label} "{commit.summary}"'

    def goal_name(self, plan: Plan) -> str:
        """Return what a plan leads to, as a person calls it."""
        return self.name_of(plan.target.revision) if plan.target.revision else ""

    def find(self, word: str, folder: Path = Path()) -> Plan | str:
        """Return the saved plan that `word` names as a file in `folder`, or `word` where it names a revision.

        Raises PicoError where it names both (`./NAME` is the file), or a file that is no plan.
        """
        path = folder / word
        is_file = path.is_file()
        if not is_file or word.startswith(("./", "../", "/")):
            if is_file:
                return plan_from_json(path.read_bytes())
            return word
        if self.is_revision(word):
            hint = f"`./{word}` is the file; rename it to mean the revision"
            raise PicoError(error("ambiguous", f"`{word}` is both a file and a revision", hint=hint))
        return plan_from_json(path.read_bytes())

    def is_revision(self, word: str) -> bool:
        """Return whether there is a revision of this name."""
        try:
            return self.folder.repository is not None and bool(self.folder.repository.resolve(word))
        except PicoError:
            return False


class HistoryReader(Reader):
    """Reads the history of the lab that `path` lies in, also while its manifests are wrong; raises PicoError."""

    def __init__(self, path: Path) -> None:
        self.folder = LabFolder(path, history=True)
