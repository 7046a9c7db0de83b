"""A lab's folder: its manifests as they are in the working tree, and its states at any revision."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history.git import command as git
from pico.history.git.commit import Commit, Head
from pico.history.git.shallow import boundary, lacking_parents
from pico.history.lab.files import write_file
from pico.history.lab.missing_files import gone_at, missing_files
from pico.history.lab.notes import Note, note_path, notes, read_note, require_part, with_note
from pico.history.writing.in_progress import refuse_begun
from pico.history.writing.lock import write_lock
from pico.history.writing.recovery import anything_left
from pico.manifest.bench_view import has_part
from pico.manifest.file_names import BENCH_LAB, LAB_DIFFERS, RENAMED
from pico.manifest.files import bench_files, read_folder, shown_path, states_alone
from pico.manifest.load import Manifests, find_lab, find_lab_of_bench, load_files
from pico.model.address import Named, former_names, renamed_keys, renamed_state, renaming_between, renaming_of
from pico.model.diff import Change, diff_states
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.state import LabState, home_state
from pico.places.lab import own_folder
from pico.policy.freshness import edited as edited_lab

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place
    from pico.edge.protocol import OwnLab
    from pico.history.repository.repository import Repository
    from pico.manifest.changes import Changes
    from pico.model.trace.expectation import Standing
    from pico.model.trace.report import Captured
    from pico.model.trace.run import Run

FULL = 40
"""Digits of the whole id of a commit."""
Safety = Literal["", "light", "hands"]
"""For what a bench is opened whatever its manifests say: to switch light off, or to empty hands, too."""
BenchFiles = tuple[tuple[str, bytes], ...]


@record
class CommitEntry:
    """One commit with what it changed on the table against its first parent, or why that can't be told.

    Where the history was asked for it: the `runs` that it carries, and how far its state is proven (`standing`; None
    where nothing claims to prove it). `first`: no commit before it has the lab. `shallow`: the clone lacks the commit
    before it, so that nobody can tell what it changed.
    """

    commit: Commit
    changes: tuple[Change, ...] = ()
    unreadable: str = ""
    runs: tuple[Run, ...] = ()
    first: bool = False
    standing: Standing | None = None
    shallow: bool = False

    @property
    def evidence(self) -> str:
        """What proves its state: `kinematic`, `physics`, `emulated` or `hardware`; `planned`; empty for nothing."""
        if self.standing is None:
            return ""
        return self.standing.evidence or ("planned" if self.standing.verdict == "planned" else "")


class LabFolder:
    """The lab that `path` lies in. Raises PicoError where there is none, or where its manifests are wrong.

    For its `history` alone, wrong manifests (a merge may be going on) are no reason to refuse: bench and state are then
    those of HEAD, and `wrong` says what is wrong.

    `place` is the bench whose runs count as the lab's own until a commit has them; without one there are none. With
    `keeps`, its `setup` is what that bench keeps as its own Lab (`own`), whatever the working tree says, which only
    proposes another one; if it keeps none yet, what the working tree says now. Else `own` is None.

    `safety`: for what switches light off or empties a hand, which never depends on the manifests. If they are wrong or
    gone, the bench is the Lab that it keeps as its own, and `wrong` says what is wrong. To switch `light` off, and not
    to move an arm, it may also be what the manifests describe, or HEAD, if its own Lab is damaged.
    """

    def __init__(
        self, path: Path, *, history: bool = False, place: Place | None = None, keeps: bool = False,
        safety: Safety = "",
    ) -> None:  # fmt: skip
        self.root, self.place = find_lab_of_bench(path) if safety else find_lab(path), place
        own_folder(self.root)
        self.wrong: PicoError | None = None
        self._keeps = keeps
        self.own = self._own_lab(place, safety) if place and keeps else None
        self._benches: dict[BenchFiles, Setup | None] = {}
        self._files: dict[str, bytes] = {}
        self._historic: dict[str, tuple[Setup, LabState]] = {}
        self._writing = False
        try:
            self._recover()
            self.reload()
        except PicoError as exc:
            self.wrong = exc
            if not (safety and self._go_by_own()) and not ((history or safety == "light") and self._stand_in()):
                raise

    @property
    def recovered(self) -> tuple[Diagnostic, ...]:
        """What killed commands had left half written here, and was brought to its end."""
        return () if self.repository is None else self.repository.noticed

    def _recover(self) -> None:
        if anything_left(self.root) and self.repository is not None:
            with self.repository.writing("pico recover"):
                pass

    def reload(self) -> None:
        """Read the manifests again, after somebody wrote them; raises PicoError where they are wrong.

        `setup`: the bench as it is now, with its types; `described`: the one that the working tree describes; `state`:
        the desired state, what the working tree says.
        """
        files, found = read_folder(self.root)
        if files == self._files and not found:
            return
        found += missing_files(self.root, files, found, lambda: self.repository)
        shown = shown_path(self.root)
        describing = bench_files(files, shown)
        if self.own is not None and self.own.as_bytes() != describing:
            self._adopt(files, self._against_own(files, found, shown))
            return
        bench = tuple(describing.items())
        known = self._benches.get(bench) if self._files and not found else None
        self._adopt(files, self._read(files, known) if known else load_files(files, found, root=shown))
        self.described = self._benches[bench] = self.setup
        if self._keeps and self.own is None:
            from pico.edge.own_lab import of_files

            self.own = of_files(describing)

    def adopt(self, own: OwnLab) -> None:
        """Read the manifests again, against what the bench keeps as its own Lab from now on; raises PicoError."""
        self.own, self._files = own, {}
        self.reload()

    def _against_own(self, files: Mapping[str, bytes], found: list[Diagnostic], shown: str) -> Manifests:
        """Return the manifests with their states read against the bench's own Lab, and what else theirs proposes."""
        from pico.edge.own_lab import setup_of

        assert self.own is not None
        own, whole = setup_of(self.own), load_files(files, found, root=shown)
        self.described = whole.setup or own
        if whole.setup and whole.setup.same_as(own):
            return whole
        wrong = load_files(bench_files(files), root=shown).diagnostics
        if whole.setup is not None and whole.setup.wiring is not None:  # how it is wired needs no adopting
            own = replace(own, wiring=whole.setup.wiring)
        read = load_files(files, found, setup=own)
        told = [d for d in wrong if d.code != "no-state" and d not in read.diagnostics]
        hinted = [_to_adopt(d, self.described) for d in read.diagnostics if not _said_of_its_part(d, whole)]
        if whole.setup and hinted == list(read.diagnostics):  # else it is said where the bench lacks something
            told.append(_proposal(own, whole.setup, whole))
        return replace(read, diagnostics=(*told, *hinted))

    @property
    def proposed(self) -> tuple[Diagnostic, ...]:
        """That the working tree describes another bench than this one keeps as its own Lab; empty where it does not."""
        return tuple(d for d in self.manifests.diagnostics if d.code == BENCH_LAB)

    def state_now(self) -> LabState | None:
        """Return what the manifests say now of this bench, which stays as it was read; None where they are wrong."""
        files, found = read_folder(self.root)
        if files == self._files and not found:
            return self.state
        read = load_files(files, setup=self.setup)
        return None if any(d.severity == "error" for d in (*found, *read.diagnostics)) else read.state

    def _read(self, files: Mapping[str, bytes], setup: Setup) -> Manifests:
        """Return manifests of which only states may have changed since the last time."""
        read = load_files(files, setup=setup)
        states = {p for p, data in files.items() if states_alone(data)}
        kept = tuple(d for d in self.manifests.diagnostics if d.source is None or d.source.path not in states)
        return replace(read, diagnostics=(*kept, *read.diagnostics))

    def _adopt(self, files: dict[str, bytes], manifests: Manifests) -> None:
        self.manifests = manifests
        self.setup, self.state = manifests.require()
        self._files = files

    def _own_lab(self, place: Place, safety: Safety) -> OwnLab | None:
        """Return the Lab that the bench keeps. If that is damaged, and only light is to be switched off, the bench is
        what its manifests describe, and no other Lab is compared with it. Raises PicoError."""
        try:
            return _kept(place)
        except PicoError as exc:
            if safety != "light":
                raise
            self.wrong, self._keeps = exc, False
            return None

    def _go_by_own(self) -> bool:
        """Take the bench from the Lab that it keeps as its own, every part at home, and return whether that was
        possible."""
        from pico.edge.own_lab import setup_of

        if self.own is None:
            return False
        try:
            self.setup = self.described = setup_of(self.own)
        except PicoError:
            return False
        self.state = home_state(self.setup)
        self.manifests = Manifests(self.setup, self.state, ())
        return True

    def _stand_in(self) -> bool:
        """Take bench and state from HEAD, and return whether that was possible."""
        try:
            self.manifests = load_files(_named("HEAD", self.history().files("HEAD", self.root, [])))
            self.setup, self.state = self.manifests.require()
            self.described = self.setup
        except PicoError:
            return False
        return True

    @cached_property
    def repository(self) -> Repository | None:
        """The Git repository around the lab, or None."""
        from pico.history.repository.repository import Repository

        return Repository.discover(self.root)

    def history(self) -> Repository:
        """Return the repository; raises PicoError that says how to get one."""
        if self.repository is None:
            hint = 'make one here: `git init && git add . && git commit -m "the lab as it is"`'
            raise PicoError(
                error("git-none", f"{self.root} is in no Git repository, so there is no history", hint=hint)
            )
        return self.repository

    def head(self) -> Head | None:
        """Return what is checked out; None outside a repository."""
        return self.repository.head() if self.repository else None

    def state_at(self, revision: str) -> LabState:
        """Return the state that a revision holds, read against the bench as it is now.

        Raises PicoError for an unknown revision and for manifests that don't fit this bench.
        """
        return self.manifests_at(revision).require()[1]

    def manifests_at(self, revision: str, *, without: Collection[str] = ()) -> Manifests:
        """Return the manifests of a revision, its states read against the bench as it is now; those of the components
        `without` which that has no part are left out."""
        found: list[Diagnostic] = []
        try:
            files = self.history().files(revision, self.root, found)
        except PicoError as exc:
            raise PicoError([_no_revision(d, revision, self.setup) for d in exc.diagnostics]) from exc
        found += gone_at(self.history(), self.root, revision, files)
        manifests = load_files(_named(revision, files), found, setup=self.setup, without=without)
        told = [_at_revision(d, revision) for d in manifests.diagnostics if d.code != RENAMED]
        then = self._bench_at(revision, files)
        if then is not None and not then.same_as(self.setup):
            told.append(_differs(then, self.setup, revision))
        return replace(manifests, diagnostics=tuple(told))

    def historic(self, revision: str) -> tuple[Setup, LabState]:
        """Return the bench and the state as a revision holds them, both as they were then; raises PicoError.

        A revision without a Lab of its own is read against the bench as it is now.
        """
        if revision in self._historic:
            return self._historic[revision]
        unread: list[Diagnostic] = []
        files = self.history().files(revision, self.root, unread)
        setup = self._bench_at(revision, files)
        found = load_files(_named(revision, files), unread, setup=setup or self.setup).require()
        if setup and len(revision) == FULL:  # the whole id of a commit means the same for ever
            self._historic = {**dict([*self._historic.items()][-3:]), revision: found}
        return found

    def _bench_at(self, revision: str, files: Mapping[str, bytes]) -> Setup | None:
        """Return the bench that the files of a revision describe; None where they describe none."""
        bench = tuple(bench_files(files).items())
        if bench not in self._benches:
            self._benches[bench] = load_files(_named(revision, files)).setup
        return self._benches[bench]

    def committed(self) -> LabState | None:
        """Return the state at HEAD, as far as the bench as it is now has its parts and slots.

        None outside a repository, before the first commit of the lab, or where it can't be read.
        """
        head = self.head()
        if head is None or head.commit is None:
            return None
        try:
            _, state = self.historic(head.commit)
        except PicoError:
            return None
        lab = self.setup.lab
        state = renamed_state(renaming_of(lab), state)
        fitting = {
            name: part
            for name, part in state.components.items()
            if name in lab.inventory and (part.slot is None or part.slot in lab.slots)
        }
        return replace(state, components=fitting)

    def diff(self, a: str | None = None, b: str | None = None) -> tuple[Change, ...]:
        """Return what differs from revision `a` (HEAD) to `b` (the working tree), exactly; raises PicoError."""
        return between(self.historic(a or "HEAD"), self.historic(b) if b else (self.setup, self.state))

    def entry(self, commit: Commit) -> CommitEntry:
        """Return a commit with its physical diff. What a first commit is compared with is every part at home."""
        try:
            after = self.historic(commit.id)
        except PicoError as exc:
            return CommitEntry(commit=commit, unreadable=str(exc.diagnostics[0].summary))
        if not commit.parents and commit.id in boundary(self.history().common):
            return CommitEntry(commit=commit, unreadable=lacking_parents(self.history().handle), shallow=True)
        return CommitEntry(commit=commit, changes=self.since(commit.parents[0] if commit.parents else None, after))

    def since(self, commit: str | None, after: tuple[Setup, LabState]) -> tuple[Change, ...]:
        """Return what changed on the table since a commit; since every part was at home, where there is none."""
        try:
            before = self.historic(commit) if commit else None
        except PicoError:
            before = None
        return between(before or (after[0], home_state(after[0])), after)

    def refuse_edits(self, way: str = "checkout") -> None:
        """Raise PicoError where git has begun something that ends before a `way` begins, else where the manifests hold
        edits that it would lose."""
        refuse_begun(self.history().own, way)
        paths = self.history().changed(self.root)
        if paths:
            raise PicoError(edited(paths))

    @contextmanager
    def writing(self, doing: str) -> Iterator[None]:
        """Be the only one who by PICO writes files of this lab and its repository; they are read anew.

        Who is inside may enter again. Raises PicoError where another one takes too long (`Repository.writing`).
        """
        if self._writing:
            yield
            return
        here = write_lock(self.root / ".pico" / "write.lock", doing)
        with self.repository.writing(doing) if self.repository else here:
            self._writing = True
            try:
                self.reload()
                yield
            finally:
                self._writing = False

    def capture(
        self, live: LabState, named: Named | None = None, found: Mapping[str, Value] = MappingProxyType({}), *,
        write: bool = True,
    ) -> Captured:  # fmt: skip
        """Write what `live` says otherwise than the manifests, beyond tolerance, into them; raises PicoError.

        `named`: only these tunables. `found`: values that light found, by address, written down to the resolution.
        Without `write`, say what would be written.
        """
        return self._written(lambda: self._spliced(live, named, found), write)

    def write_wanted(self, goal: LabState, named: Named, *, write: bool = True) -> Captured:
        """Write what `goal` says of `named` into the manifests, as it says it; raises PicoError. Without `write`, say
        what would be written."""
        from pico.manifest.changes import asked_for

        return self._written(lambda: self._with(asked_for(self.setup, self.state, goal, named)), write)

    def _with(self, changes: Changes) -> dict[str, bytes]:
        from pico.manifest.capture import with_changes

        return with_changes(self._files, self.setup, changes, self.described.lab.inventory)

    def _written(self, splicing: Callable[[], dict[str, bytes]], write: bool) -> Captured:
        """Write what `splicing` makes of the files as they are by then; without `write`, say what it would."""
        if not write:
            return self._captured(splicing(), written=False)[0]
        with self.writing("pico capture"):
            spliced = splicing()
            found, manifests = self._captured(spliced, written=True)
            for name, data in sorted(spliced.items()):
                write_file(Path(name), data, self.root / ".pico")
            self._adopt({**self._files, **spliced}, manifests)
            return found

    def preview(
        self, live: LabState, named: Named | None = None, found: Mapping[str, Value] = MappingProxyType({})
    ) -> tuple[Captured, LabState]:
        """Return what a capture would write, and the state that the manifests would then hold; raises PicoError."""
        captured, manifests = self._captured(self._spliced(live, named, found), written=False)
        return captured, manifests.require()[1]

    def _spliced(self, live: LabState, named: Named | None, found: Mapping[str, Value]) -> dict[str, bytes]:
        from pico.manifest.capture import capture

        known = self.described.lab.inventory
        return capture(self._files, self.setup, self.state, live, named, known, found)

    def _captured(self, spliced: Mapping[str, bytes], *, written: bool) -> tuple[Captured, Manifests]:
        from pico.model.trace.report import Captured

        manifests = self._read({**self._files, **spliced}, self.setup) if spliced else self.manifests
        after = manifests.require()[1]
        captured = Captured(
            changes=diff_states(self.setup, self.state, after),
            files=tuple(sorted(spliced)),
            written=written,
            patch="".join(_patch(name, self._files[name], spliced[name]) for name in sorted(spliced)),
        )
        return captured, manifests

    def notes(self, part: str) -> tuple[Note, ...]:
        """Return what people noted on a part, oldest first; raises PicoError where there is no such part."""
        part = require_part(self.setup, part)
        called = (*former_names(self.setup.lab, part), part)
        return notes({note_path(name): read_note(self.root, name) for name in called}, *called)

    def note(self, part: str, text: str) -> Note:
        """Note something on a part; its author and day are those that git would give a commit. Raises PicoError."""
        part = require_part(self.setup, part)
        author, day = git.author(self.root)
        with self.writing("pico note"):
            path = self.root / note_path(part)
            before = read_note(self.root, part)
            write_file(path, with_note(before, day, author, text), self.root / ".pico")
        return self.notes(part)[-1]


def _kept(place: Place) -> OwnLab | None:
    from pico.edge.network.opening import own_lab

    return own_lab(place)


def _proposal(own: Setup, described: Setup, read: Manifests) -> Diagnostic:
    """Return that the working tree describes another bench than this one keeps as its own."""
    edited = edited_lab(own, described)
    text = f"this bench is not the one that the lab's files describe: {', '.join(edited)}"
    hint = "plans go by the bench. At a commit of another time there is nothing to do; of an edit `pico bench update`"
    hint = f"{hint} shows the difference, and lets the bench adopt it"
    source = read.source(edited[0].split()[0]) if edited else None
    return warning(BENCH_LAB, text, hint=hint, source=source)


def _said_of_its_part(d: Diagnostic, whole: Manifests) -> bool:
    """Return whether the bench lacks a component for another mistake: one in the inventory that the files describe."""
    if d.code != "unknown-component" or whole.setup is not None:
        return False
    return any(has_part(document, d.address.partition(".")[0]) for document in whole.documents.get("Lab", ()))


def _to_adopt(d: Diagnostic, described: Setup) -> Diagnostic:
    """Return a diagnostic of a state; what the bench lacks, the working tree may propose."""
    if d.code != "unknown-component" or d.address.partition(".")[0] not in described.lab.inventory:
        return d
    return replace(d, hint="the working tree's inventory has it, the bench not yet: `pico bench update` adopts it")


def _differs(then: Setup, now: Setup, revision: str) -> Diagnostic:
    text = f"since {revision} the bench was changed: {', '.join(edited_lab(then, now))}"
    return warning(LAB_DIFFERS, text, hint="planned for the bench as it is now")


def _named(revision: str, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files by the names that diagnostics show: `e1:state/table.yaml`."""
    return {f"{revision}:{path}": data for path, data in files.items()}


def _no_revision(d: Diagnostic, revision: str, setup: Setup) -> Diagnostic:
    """Return a diagnostic of a revision that there is not; a component may have been meant."""
    if revision not in setup.lab.inventory:
        return d
    return replace(d, hint=f"{revision} is a component, and goes after `--`: `-- {revision}`, or `REV -- {revision}`")


def _at_revision(d: Diagnostic, revision: str) -> Diagnostic:
    """Return a diagnostic of a state from history: what the bench lacks now, it may have had then."""
    if d.code != "unknown-component":
        return d
    name = d.address.partition(".")[0]
    hint = f"{revision} was made when the bench had it: take it into `inventory` again, or leave it out with `--exclude"
    hint = f"{hint} {name}`. If it has another name now, give that part `formerly: [{name}]`"
    return replace(d, hint=hint)


def between(a: tuple[Setup, LabState], b: tuple[Setup, LabState]) -> tuple[Change, ...]:
    """Return what differs between two states, each with its own bench; where the benches differ, the later counts."""
    (bench_a, state_a), (bench_b, state_b) = a, b
    names = renaming_between(bench_a.lab, bench_b.lab)
    inventories = (renamed_keys(names, bench.lab.inventory) for bench in (bench_a, bench_b))
    lab = replace(
        bench_b.lab,
        inventory={name: part for inventory in inventories for name, part in inventory.items()},
        slots={**bench_a.lab.slots, **bench_b.lab.slots},
    )
    both = Setup(lab=lab, catalog={**bench_a.catalog, **bench_b.catalog})
    return diff_states(both, renamed_state(names, state_a), renamed_state(names, state_b))


def _patch(name: str, before: bytes, after: bytes) -> str:
    old, new = (data.decode(errors="replace").splitlines(keepends=True) for data in (before, after))
    lines = difflib.unified_diff(old, new, f"a/{name}", f"b/{name}", n=1)
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)


def edited(paths: tuple[str, ...]) -> Diagnostic:
    """Return that files are edited, and what can be done with the edits."""
    return error(
        "edited",
        f"edits that are not committed: {', '.join(paths[:3])}{' and others' if len(paths) > 3 else ''}",
        hint='`pico commit --planned -m "why"` keeps the edits (without --planned those that were applied), '
        "`pico stash` shelves them, `git restore .` drops them",
    )
