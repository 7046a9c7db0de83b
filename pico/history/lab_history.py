"""The history of a lab: what its folder and Git tell and do, without a bench."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.lab.folder import CommitEntry, LabFolder
from pico.history.lab.notes import Note
from pico.model.plan import Plan, plan_from_json

if TYPE_CHECKING:
    from pico.history.blame.blamed import Blamed
    from pico.history.data.lab import LabData
    from pico.history.diff.states import StateDiff
    from pico.history.git.commit import Commit
    from pico.history.log import Log
    from pico.history.merge.commits import MergeMade
    from pico.history.restoring.selected import SelectedParts
    from pico.history.restoring.stash import Stash
    from pico.history.restoring.transplant import Transplanted
    from pico.history.runs.comparing import Comparison
    from pico.history.shown import Shown
    from pico.model.trace.run import Run
    from pico.runs.document import RecordedRun


class LabHistory:
    """Reads and makes the history of the lab in a folder; raises PicoError."""

    def __init__(self, folder: LabFolder) -> None:
        self.folder = folder

    def compare(
        self, a: str | None = None, b: str | None = None, names: Sequence[str] = (), *, at: Path | None = None
    ) -> StateDiff:
        """Return all that differs from revision `a` (HEAD; it may be a range) to `b` (the working tree).

        `names`: of these components and files alone, paths relative to `at` (the lab). Raises PicoError.
        """
        from pico.history.diff.states import compare
        from pico.history.lab.scope import read_scope

        scope = read_scope(self.folder, names, at or self.folder.root, past=True)
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

        scope = read_scope(self.folder, names, at or self.folder.root, past=True)
        asked = LogRequest(
            revisions=revisions, every=every, options=tuple(options), limit=limit, scope=scope, topological=graph
        )
        return Log(self.folder, asked)

    def blame(self, *what: str, at: str | None = None, history: bool = False) -> Blamed:
        """Return who last changed these components and tunables, all for none; see `pico.history.blame.blamed`."""
        from pico.history.blame.blamed import blame

        return blame(self.folder.root, what, at=at, history=history)

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
        """Return what is checked out as a person calls it; empty without Git and before the first commit."""
        head = self.folder.head()
        return head.label if head and head.commit else ""

    def here(self) -> str:
        """Return what to check out to come back to what is checked out now: the branch, else the commit's short id."""
        head = self.folder.head()
        if head is None or head.branch is None:
            return (head.commit or "")[:7] if head else ""
        return head.branch if self.is_revision(head.branch) or not head.commit else f"heads/{head.branch}"

    def head_commit(self) -> str | None:
        """Return the id of the commit checked out; None without Git or before the first commit."""
        head = self.folder.head()
        return head.commit if head else None

    def name_of(self, revision: str) -> str:
        """Return `e1 (E1-3 "p2 tilted")` for a revision; raises PicoError."""
        repository = self.folder.history()
        commit = repository.resolve(revision)
        label = commit.label if revision in ("HEAD", commit.id) else repository.spelled(revision)
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

    def parts_at(self, revision: str, names: Sequence[str]) -> SelectedParts:
        """Return what the manifests must say for parts of a state to be as in a revision; see `restoring.checked`."""
        from pico.history.restoring import checked

        return checked.select_parts(self.folder, revision, names)

    def runs(self, revision: str | None = None, **options: Any) -> tuple[tuple[Run, Commit | None], ...]:
        """Return the runs that commits carry, and those that none has yet; see `runs.listing.list_runs`."""
        from pico.history.runs.listing import list_runs

        return list_runs(self.folder, revision, **options)

    def runs_of_others(self, diagnostics: list[Diagnostic] | None = None) -> tuple[Run, ...]:
        """Return the runs that others began at a bench that is shared, and no commit here has, the newest first."""
        from pico.history.runs.uncommitted import of_others

        return tuple(run.document for run in reversed(of_others(self.folder, diagnostics=diagnostics)))

    def recorded_run(self, word: str | None = None) -> tuple[RecordedRun, Commit | None]:
        """Return a run by the beginning of its id, the last one for None; see `pico.history.runs.loading.load_run`."""
        from pico.history.runs.loading import load_run

        return load_run(self.folder, word)

    def compare_runs(self, a: str, b: str) -> Comparison:
        """Return two runs side by side; see `pico.history.runs.comparing`."""
        from pico.history.runs.comparing import compare_runs

        return compare_runs(self.folder.setup, self.recorded_run(a)[0], self.recorded_run(b)[0])

    def merge(self, revision: str, message: str = "") -> MergeMade:
        """Merge a revision into what is checked out, where the result can stand on the table; see `merge.checked`."""
        from pico.history.merge.checked import merge

        return merge(self.folder, revision, message)

    @property
    def data(self) -> LabData:
        """The large data of the lab's runs: what is needed, here and where copies are kept; see `history.data.lab`."""
        from pico.history.data.lab import LabData

        return LabData(self.folder.history())

    def revert(
        self, revision: str, message: str = "", *, mainline: int | None = None, commit: bool = True
    ) -> Transplanted:
        """Take back what a revision changed, in the manifests; see `pico.history.restoring.checked`."""
        from pico.history.restoring import checked

        return checked.revert(self.folder, revision, message=message, mainline=mainline, commit=commit)

    def cherry_pick(
        self, revisions: Sequence[str], *, mainline: int | None = None, commit: bool = True
    ) -> tuple[Transplanted, ...]:
        """Do once more what revisions changed, in the manifests; see `pico.history.restoring.checked`."""
        from pico.history.restoring import checked

        return checked.cherry_pick(self.folder, revisions, mainline=mainline, commit=commit)

    @property
    def stash(self) -> Stash:
        """The stash of the repository: edits of the manifests that are shelved; see `pico.history.restoring.stash`."""
        from pico.history.restoring.stash import Stash

        return Stash(self.folder)

    def checkout(self, revision: str | SelectedParts) -> None:
        """Check a revision out with git, or write what is taken from one. Moves nothing; raises PicoError, before
        anything is checked out if the revision requires another PICO, and with the way back if its files are wrong.

        The bench stays what it is, for a revision can't change which parts there are.
        """
        if not isinstance(revision, str):
            revision.write(self.folder)
            return
        self._require_version(revision)
        before = self.here()
        self.folder.history().checkout(revision)
        try:
            self.folder.reload()
        except PicoError as exc:
            text = f"the files are at {revision} now, and the manifests there are wrong; nothing moved"
            hint = f"correct them, or `git checkout {before}` goes back"
            raise PicoError([*exc.diagnostics, error("checked-out", text, hint=hint)], exc.exit_code) from exc

    def _require_version(self, revision: str) -> None:
        """Raise PicoError if a revision requires another PICO; git itself says what else is wrong."""
        from pico.manifest.checks.required_version import require_satisfied

        try:
            found = self.folder.manifests_at(revision).diagnostics
        except PicoError:
            return
        require_satisfied(found)
