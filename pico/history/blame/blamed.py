"""`pico blame`: for each leaf of a state its value, the last commit that changed it, and how."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning
from pico.history.blame.answer import Answer, BlamedRow, Unread
from pico.history.blame.edits import with_edits
from pico.history.blame.flat import flatten
from pico.history.blame.follow import Address, LeafNode
from pico.history.blame.how import How, how
from pico.history.blame.leaves import POSE, Leaf, canonical, shown
from pico.history.blame.walk import Walker
from pico.history.git.commit import Commit
from pico.history.lab.notes import Note, note_path, notes
from pico.history.repository.repository import Repository
from pico.manifest.file_names import MAX_BYTES
from pico.manifest.files import read_folder
from pico.model.address import Renaming
from pico.model.catalog import Tunable
from pico.model.diff import describe_move, describe_value
from pico.model.pose import Pose
from pico.model.record import record


@record
class LeafChange:
    """One change of a leaf: the `commit` that made it (None: not committed), its first name or short id, and how.

    `before` and `after` are as in a `Change`, None where there is none; `text` says them as a motion. `earlier`: this
    clone is shallow, and an older commit that it lacks may have made it.
    """

    commit: str | None = None
    name: str = ""
    author: str = ""
    time: str = ""
    summary: str = ""
    how: How
    before: Any = None
    after: Any = None
    text: str = ""
    earlier: bool = False


@record
class BlamedLeaf:
    """One leaf of the state: its value (None: it is gone), the unit, and who changed it `last`.

    `history`: all that changed it, newest first, where that was asked for."""

    component: str
    tunable: str
    value: Any = None
    unit: str = ""
    last: LeafChange
    history: tuple[LeafChange, ...] | None = None


@record
class Blamed:
    """The leaves of a state, by component, pose first; `commit` whose state it is, with edits where `edited`.

    `notes`: those on the components that were asked for."""

    commit: str | None = None
    name: str = ""
    edited: bool = False
    leaves: tuple[BlamedLeaf, ...] = ()
    notes: Mapping[str, tuple[Note, ...]] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()


def blame(root: Path, what: Sequence[str] = (), *, at: str | None = None, history: bool = False) -> Blamed:
    """Return who last changed each leaf of the lab in `root`: of its state at HEAD with what was edited since, or `at`
    a revision.

    `what`: components and tunables (`p2`, `p1.angle`, `p2.pose`), all where empty; those that are gone count, too.
    `history`: with every change of each. Raises PicoError without a repository, for an unknown revision or name, and
    for damaged objects.
    """
    repository = Repository.discover(root)
    if repository is None:
        hint = 'make one here: `git init && git add . && git commit -m "the lab as it is"`'
        raise PicoError(error("git-none", f"{root} is in no Git repository, so there is no history", hint=hint))
    commit = repository.resolve(at).id if at is not None else repository.head().commit
    walker = Walker(repository, repository.relative(root))
    if at is not None and commit and not walker.has_lab(commit):
        hint = "the lab may have had another folder then"
        raise PicoError(error("revision", f"`{at}` has no folder {walker.folder}", hint=hint))
    try:
        found = walker.answer(commit) if commit else Answer()
        whole = found if at is not None else with_edits(walker, root, commit, found)
        names = _renaming(root)
        rows = _chosen(whole.rows, [_called(names, word, whole.rows) for word in what])
        turns = _Turns(walker, whole, rows.values(), names, history=history)
        leaves = tuple(turns.leaf(address, row) for address, row in rows.items())
        parts = dict.fromkeys(leaf.component for leaf in leaves) if what else ()
        noted = {part: _notes(walker, root, commit if at else None, part, names) for part in parts}
    finally:
        walker.cache.close()
    return Blamed(
        commit=commit,
        name=at or repository.head().label,
        edited=any(row.node.commit == "" for row in whole.rows.values()),
        leaves=leaves,
        notes={part: said for part, said in noted.items() if said},
        diagnostics=tuple(_skipped(whole.unread)),
    )


def _renaming(root: Path) -> Renaming:
    """Return the present names of the parts of the lab in `root` by their former ones."""
    files, _ = read_folder(root)
    return {old: new for data in files.values() for new, names in flatten(data).formerly.items() for old in names}


def _called(names: Renaming, word: str, rows: Iterable[Address]) -> str:
    """Return a word as the rows call its component, which may have another name by now, or had one then."""
    component, there = word.partition(".")[0], {at[0] for at in rows}
    now = names.get(component, component)
    known = (component, now, *(old for old, new in names.items() if new == now))
    return next((name for name in known if name in there), component) + word[len(component) :]


def _notes(walker: Walker, root: Path, commit: str | None, part: str, names: Renaming) -> tuple[Note, ...]:
    """Return the notes on a part, at a commit or in the working tree, those on its former names included."""
    called = (*(old for old, new in names.items() if new == part), part)
    found = {}
    for path in map(note_path, called):
        file = root / path
        if commit:
            found[path] = walker.content(commit, path)
        elif file.is_file() and not file.is_symlink():
            found[path] = file.read_bytes()[:MAX_BYTES]
    return notes(found, *called)


def _chosen(rows: Mapping[Address, BlamedRow], what: Sequence[str]) -> dict[Address, BlamedRow]:
    """Return the rows that are asked for; of a component as a whole those that are not gone, unless all of it is."""
    if not what:
        return {at: row for at, row in rows.items() if row.value is not None or row.node.commit == ""}
    asked: set[Address] = set()
    wrong: list[Diagnostic] = []
    for word in what:
        component, _, tunable = word.partition(".")
        mine = [at for at in rows if at[0] == component]
        tunable = POSE if tunable == "slot" or tunable.startswith("pose.") else tunable
        if not mine or (tunable and (component, tunable) not in mine):
            wrong.append(_unknown(component, tunable, mine, rows))
        elif tunable:
            asked.add((component, tunable))
        else:
            there = [at for at in mine if rows[at].value is not None or rows[at].node.commit == ""]
            asked.update(there or mine)
    if wrong:
        raise PicoError(wrong)
    return {at: row for at, row in rows.items() if at in asked}


def _unknown(component: str, tunable: str, mine: Iterable[Address], rows: Iterable[Address]) -> Diagnostic:
    known = [at[1] for at in mine]
    if known:
        summary = f"no commit up to here gives {component}.{tunable[:40]} a value"
        return error("unknown-tunable", summary, hint=did_you_mean(tunable[:40], known), address=component)
    hint = did_you_mean(component[:40], {at[0] for at in rows})
    summary = f"neither the lab nor its history has a component `{component[:40]}`"
    return error("unknown-component", summary, hint=hint or "`pico blame` lists what there is")


class _Turns:
    """Puts nodes, commits and runs together."""

    def __init__(
        self, walker: Walker, whole: Answer, rows: Iterable[BlamedRow], names: Renaming, *, history: bool
    ) -> None:
        self.former = {now: tuple(old for old, new in names.items() if new == now) for now in names.values()}
        self.history, self.shallow = history, walker.shallow
        nodes = [n for row in rows for n in (row.node.chain() if history else (row.node,))]
        wanted = {n.commit for n in nodes if n.commit}
        self.commits: Mapping[str, Commit] = walker.repository.commits(wanted)
        self.runs = whole.runs

    def leaf(self, at: Address, row: BlamedRow) -> BlamedLeaf:
        turns = tuple(self.turn(at, node, row.unit) for node in row.node.chain()) if self.history else None
        last = turns[0] if turns else self.turn(at, row.node, row.unit)
        value = shown(row.value)
        return BlamedLeaf(component=at[0], tunable=at[1], value=value, unit=row.unit, last=last, history=turns)

    def turn(self, at: Address, node: LeafNode, unit: str) -> LeafChange:
        before, after = (_value(at, n, unit) for n in (node.before, node))
        text = _text(at, before, after, unit)
        if not node.commit:
            return LeafChange(how=How(kind="edit"), before=before, after=after, text=text)
        commit = self.commits[node.commit]
        return LeafChange(
            commit=commit.id, name=commit.label, author=commit.author.partition(" <")[0], time=commit.time.isoformat(),
            summary=commit.summary, before=before, after=after, text=text, earlier=commit.id in self.shallow,
            how=how(commit, self.runs.get(commit.id, ()), at, after, self.former.get(at[0], ())),
        )  # fmt: skip


def _value(at: Address, node: LeafNode | None, unit: str) -> Any:
    leaf: Leaf | None = node.value if node else None
    return shown(canonical(at[1], leaf, unit))


def _text(at: Address, before: Any, after: Any, unit: str) -> str:
    if after is None:
        return "taken out"
    if at[1] != POSE:
        words = describe_value(Tunable(unit=unit), before, after)
        return words if before is not None else f"set to {words.partition(' → ')[2]}"
    (slot_a, pose_a), (slot_b, pose_b) = _place(before), _place(after)
    if before is None:
        return f"in {slot_b}" if slot_b else f"placed at {pose_b}"
    return describe_move(slot_a, pose_a, slot_b, pose_b)


def _place(value: Any) -> tuple[str | None, Pose]:
    if isinstance(value, dict) and all(isinstance(n, int | float) for n in value.values()):
        return None, Pose(**value)
    return str(value), Pose(0.0, 0.0)


def _skipped(unread: Sequence[Unread]) -> list[Diagnostic]:
    """Return a warning for each manifest that could not be read somewhere in the history."""
    found: dict[str, list[Unread]] = {}
    for entry in unread:
        found.setdefault(entry.path, []).append(entry)
    result = []
    for path, entries in sorted(found.items()):
        names = ", ".join(e.commit[:7] or "the working tree" for e in entries[-3:])
        more = f" and {len(entries) - 3} more commits" if len(entries) > 3 else ""
        hint = "what it changed there is told of the next commit in which it can be read"
        result.append(warning("skipped", f"{path} can't be read at {names}{more}", detail=entries[-1].why, hint=hint))
    return result
