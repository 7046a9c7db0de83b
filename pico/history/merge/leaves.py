"""What three versions of a manifest say, merged value by value: who changed what, and where both sides disagree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pico.manifest.text.splice import write_flow
from pico.manifest.text.tree import List, Map, Node, Scalar, plain
from pico.model.state import is_reference

Path = tuple[str, ...]
Groups = Mapping[str, tuple[tuple[str, ...], ...]]
"""By component, the tunables that mean something only together; its pose always is such a group."""

_PLACE = ("slot", "pose")
_ABSENT: Any = object()
OUT = "taken out"


@dataclass(frozen=True, slots=True)
class Conflict:
    """One thing that both sides changed, each in its own way. `path` begins with the number of the document.

    `base`, `ours` and `theirs` are as a person reads them, the latter two with the distance from the base.
    `keys`: the entries that stand in one another's place, where it is not one value that differs. `files`: where it is
    the file of a component on which the sides disagree, those that have it.
    """

    path: Path
    base: str
    ours: str
    theirs: str
    keys: tuple[str, ...] = ()
    files: tuple[str, ...] = ()

    @property
    def out(self) -> int | None:
        """Which side took a component out that the other moved to another file: 0 ours, 1 theirs, None neither."""
        return (self.ours, self.theirs).index(OUT) if self.files and OUT in (self.ours, self.theirs) else None

    @property
    def address(self) -> str:
        """What it is about: `p1.pose.x`, or the keys of another manifest."""
        return ".".join(self.path[2:] if self.path[1:2] == ("components",) and len(self.path) > 2 else self.path[1:])


@dataclass(frozen=True, slots=True)
class Coupled:
    """Tunables of one group, some changed by one side alone and others by the other: merged, but maybe wrong."""

    component: str
    ours: tuple[str, ...]
    theirs: tuple[str, ...]


@dataclass
class MergedLeaves:
    """What the merged manifest must say: with ours, and with theirs, where they disagree."""

    ours: Any = None
    theirs: Any = None
    conflicts: list[Conflict] = field(default_factory=list)
    coupled: list[Coupled] = field(default_factory=list)


def canonical(node: Node | None) -> Any:
    """Return a node as data in which 1 equals 1.0, but neither "1" nor true."""
    if isinstance(node, Scalar):
        value = node.value
        number = isinstance(value, int | float) and not isinstance(value, bool)
        return ("number", repr(float(value))) if number else (type(value).__name__, value)  # type: ignore[arg-type]
    if isinstance(node, List):
        return [canonical(item) for item in node.items]
    if isinstance(node, Map):
        return {key: canonical(filled(key, value)) for key, (_, value) in node.entries.items()}
    return _ABSENT


def filled(key: str, node: Node | None) -> Node | None:
    """Return a value, a mapping without entries for `components:` with nothing behind it."""
    nothing = key == "components" and isinstance(node, Scalar) and node.value is None
    return Map(node.start, True, node.end) if nothing and node else node


def single(node: Node | None) -> bool:
    """Return whether a node is one value: a scalar, a list, or a set-point that light finds, which means something only
    as a whole."""
    return isinstance(node, Scalar | List) or (isinstance(node, Map) and node.flow and is_reference(node.entries))


def leaves(node: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield everything below a node that is no mapping with entries, or a single value, with its path."""
    if isinstance(node, Map) and node.entries and not single(node):
        for key, (_, value) in node.entries.items():
            yield from leaves(value, (*path, key))
    else:
        yield path, node


def merge_leaves(
    base: Sequence[Node | None], ours: Sequence[Node], theirs: Sequence[Node], groups: Groups, *, strict: bool = False
) -> MergedLeaves:
    """Merge the roots of the documents of three versions; `strict`: coupled tunables count as a conflict."""
    outcome = MergedLeaves(ours=[], theirs=[])
    for i, (b, o, t) in enumerate(zip(base, ours, theirs, strict=True)):
        coupled = list(_coupled(i, b, o, t, groups)) if _is_state(o) else []
        forced = {path for _, paths in coupled for path in paths} if strict else set()
        outcome.coupled += [] if strict else [found for found, _ in coupled]
        merged = _Merge(outcome.conflicts, forced, _is_state(o)).node((str(i),), b, o, t)
        outcome.ours.append(merged[0])
        outcome.theirs.append(merged[1])
    return outcome


def _is_state(node: Node) -> bool:
    kind = node.get("kind") if isinstance(node, Map) else None
    return isinstance(kind, Scalar) and kind.text == "LabState"


class _Merge:
    def __init__(self, conflicts: list[Conflict], forced: set[Path], state: bool) -> None:
        self.conflicts, self.forced, self.state = conflicts, forced, state

    def node(self, path: Path, b: Node | None, o: Node | None, t: Node | None) -> tuple[Any, Any]:
        """Return what the merged node says with ours and with theirs; nodes that are not there are None."""
        whole = any(isinstance(n, Map) and single(n) for n in (b, o, t))
        if isinstance(o, Map) and isinstance(t, Map) and (b is None or isinstance(b, Map)) and not whole:
            return self.maps(path, b, o, t)
        was, mine, other = canonical(b), canonical(o), canonical(t)
        if path not in self.forced:
            if other in (mine, was):
                return mine, mine
            if mine == was:
                return other, other
        keys = () if single(o) and single(t) else (path[-1],)
        self.conflicts.append(Conflict(path, shown(b), _against(b, o), _against(b, t), keys))
        return mine, other

    def maps(self, path: Path, b: Map | None, o: Map, t: Map) -> tuple[dict[str, Any], dict[str, Any]]:
        with_ours: dict[str, Any] = {}
        with_theirs: dict[str, Any] = {}
        done: tuple[str, ...] = ()
        if self.state and len(path) == 3 and path[1] == "components":
            done = self.place(path, b, o, t, with_ours, with_theirs)
        for key in dict.fromkeys([*(b.entries if b else ()), *o.entries, *t.entries]):
            if key in done:
                continue
            mine, other = self.node((*path, key), *(filled(key, n.get(key)) if n else None for n in (b, o, t)))
            with_ours |= {} if mine is _ABSENT else {key: mine}
            with_theirs |= {} if other is _ABSENT else {key: other}
        return with_ours, with_theirs

    def place(
        self, path: Path, b: Map | None, o: Map, t: Map, with_ours: dict[str, Any], with_theirs: dict[str, Any]
    ) -> tuple[str, ...]:
        """Merge slot and pose as the one thing that they are where a side changed from one to the other."""
        was, mine, other = (_places(node) for node in (b, o, t))
        if mine.keys() == other.keys():
            return ()
        if was in (mine, other):
            new = other if mine == was else mine
            with_ours.update(new)
            with_theirs.update(new)
            return _PLACE
        base, ours, theirs = (_shown_place(node) for node in (b, o, t))
        self.conflicts.append(Conflict((*path, "pose"), base, ours, theirs, _PLACE))
        with_ours.update(mine)
        with_theirs.update(other)
        return _PLACE


def _places(node: Map | None) -> dict[str, Any]:
    return {key: canonical(node.get(key)) for key in _PLACE if key in node.entries} if node else {}


def _shown_place(node: Map | None) -> str:
    where = next((node.get(key) for key in _PLACE if key in node.entries), None) if node else None
    return shown(where)


def shown(node: Node | None) -> str:
    """Return a node as a person reads it, on one line."""
    if node is None:
        return "absent"
    value = plain(node)
    text = write_flow(value) if not isinstance(value, list) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _against(base: Node | None, node: Node | None) -> str:
    if node is None:
        return "removed"
    a, b = plain(base) if base else None, plain(node)
    if isinstance(node, Map) and isinstance(base, Map) and not single(node):
        return "changed: " + shown(node)
    if _number(a) and _number(b):
        return f"{shown(node)} ({b - a:+.6g})" if a != b else f"{shown(node)} (unchanged)"
    return shown(node)


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _coupled(
    document: int, b: Node | None, o: Node, t: Node, groups: Groups
) -> Iterator[tuple[Coupled, tuple[Path, ...]]]:
    """Yield each group of which one side alone changed one part and the other side alone another one."""
    was, mine, other = ({p: canonical(n) for p, n in leaves(node)} if node else {} for node in (b, o, t))
    paths = [p for p in sorted(was.keys() & mine.keys() & other.keys()) if p[:1] == ("components",) and len(p) > 2]
    by_ours = {p for p in paths if mine[p] != was[p] and other[p] == was[p]}
    by_theirs = {p for p in paths if other[p] != was[p] and mine[p] == was[p]}
    for component in sorted({p[1] for p in by_ours} & {p[1] for p in by_theirs}):
        for group in (("pose",), *groups.get(component, ())):
            here = [[p for p in sorted(by) if p[1] == component and p[2] in group] for by in (by_ours, by_theirs)]
            if all(here):
                ours, theirs = (tuple(".".join(p[2:]) for p in found) for found in here)
                yield Coupled(component, ours, theirs), tuple((str(document), *p) for p in (*here[0], *here[1]))
