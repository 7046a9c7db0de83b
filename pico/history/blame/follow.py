"""Which commit gave each leaf of a state its value: a walk from the first commit to the last, over data alone.

As in `git blame`, what a parent has already is the parent's, the first parent's before the others'. A leaf is known by
its component and tunable, never by its file; two texts of the same quantity are the same value.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from pico.history.blame.flat import Flat
from pico.history.blame.leaves import POSE, Leaf, canonical

Address = tuple[str, str]
"""Component and tunable."""
Delta = Mapping[str, Flat | None]
"""By path the manifests that differ from the first parent's; None for one that is gone."""
Units = Callable[[str], Mapping[str, str]]
"""Returns the units of the tunables of a packaged component type."""


@dataclass(frozen=True, slots=True, eq=False)
class LeafNode:
    """A leaf since `commit`: its value (None: it is gone), and what it was `before` that."""

    value: Leaf | None
    commit: str
    before: LeafNode | None = None

    def chain(self) -> Iterator[LeafNode]:
        """Yield this and all before it, newest first."""
        node: LeafNode | None = self
        while node is not None:
            yield node
            node = node.before


@dataclass(frozen=True, slots=True)
class WalkStep:
    """One commit on the walk, with its parents."""

    commit: str
    parents: tuple[str, ...] = ()


@dataclass(slots=True)
class Blame:
    """The leaves of one commit, each with its node; leaves that are gone have one, too."""

    nodes: dict[Address, LeafNode] = field(default_factory=dict)
    files: dict[str, Flat] = field(default_factory=dict)
    _states: dict[str, tuple[str, ...]] = field(default_factory=dict)  # component -> the files that state it
    _parts: dict[str, tuple[str, ...]] = field(default_factory=dict)  # part -> the files whose inventory has it
    _types: dict[str, tuple[str, ...]] = field(default_factory=dict)
    _names: dict[str, str] = field(default_factory=dict)  # former name of a part -> the present one

    @classmethod
    def of(cls, files: Mapping[str, Flat], nodes: Mapping[Address, LeafNode]) -> Blame:
        """Return the blame of a commit that holds `files`, where its nodes are known."""
        blame = cls(dict(nodes))
        for path, flat in files.items():
            blame._put(path, flat)
        blame._names = blame._renaming()
        return blame

    def copy(self) -> Blame:
        """Return a copy that can go its own way."""
        return Blame(
            dict(self.nodes), dict(self.files), dict(self._states), dict(self._parts), dict(self._types),
            dict(self._names),
        )  # fmt: skip

    def leaves(self, component: str) -> dict[str, Leaf]:
        """Return the leaves of a component; one that no state places is where its inventory has it."""
        called = next((name for name in (component, *self._former(component)) if name in self._states), "")
        found = dict(self.files[self._states[called][0]].state[called]) if called else {}
        home = self._part(component)[1]
        if home and POSE not in found:
            found[POSE] = home
        return found

    def unit(self, component: str, tunable: str, packaged: Units) -> str | None:
        """Return the declared unit of a tunable; None where nobody knows it."""
        kind = self._part(component)[0]
        own = self._types.get(kind)
        return (self.files[own[0]].units[kind] if own else packaged(kind)).get(tunable)

    def components(self) -> Iterable[str]:
        """Return every component that a state or the inventory names, by its present name."""
        return {self._names.get(name, name) for name in self._states} | self._parts.keys()

    def put(self, delta: Delta, commit: str, packaged: Units, others: Sequence[Blame] = ()) -> None:
        """Go on to a commit that differs by `delta` from this one, its first parent; `others`: its other parents.

        A manifest that can't be read counts as it was before.
        """
        readable = {path: flat for path, flat in delta.items() if not (flat and flat.wrong)}
        touched = {name for path, flat in readable.items() for name in _touched(self.files.get(path), flat)}
        touched |= {self._names[name] for name in touched if name in self._names}
        before = {name: self.leaves(name) for name in touched}
        for path, flat in readable.items():
            self._put(path, flat)
        self._rename(readable, before)
        for name in {self._names.get(name, name) for name in before}:
            was, now = before[name], self.leaves(name)
            for tunable in was.keys() | now.keys():
                old, new = was.get(tunable), now.get(tunable)
                if old != new and not self._same((name, tunable), old, new, packaged):
                    self._change((name, tunable), new, commit, packaged, others)

    def _rename(self, delta: Delta, before: dict[str, dict[str, Leaf]]) -> None:
        """Let parts that were renamed by `delta` keep their nodes, and what they were `before` that."""
        if not any(flat is None or flat.inventory for flat in delta.values()):
            return
        known, self._names = self._names, self._renaming()
        for old, new in self._names.items() - known.items():
            if not before.get(new):
                before[new] = before.pop(old, {})
            for at in [at for at in self.nodes if at[0] == old and (new, at[1]) not in self.nodes]:
                self.nodes[new, at[1]] = self.nodes.pop(at)

    def _renaming(self) -> dict[str, str]:
        found = {old: new for flat in self.files.values() for new, names in flat.formerly.items() for old in names}
        return {old: new for old, new in found.items() if old not in self._parts}

    def _former(self, component: str) -> Iterator[str]:
        return (old for old, new in self._names.items() if new == component)

    def _change(self, at: Address, new: Leaf | None, commit: str, packaged: Units, others: Sequence[Blame]) -> None:
        for other in others:
            called = (at[0], *self._former(at[0]))
            theirs = next((other.nodes[name, at[1]] for name in called if (name, at[1]) in other.nodes), None)
            if self._same(at, theirs.value if theirs else None, new, packaged):
                if theirs:
                    self.nodes[at] = theirs
                else:
                    del self.nodes[at]
                return
        self.nodes[at] = LeafNode(new, commit, self.nodes.get(at))

    def _same(self, at: Address, a: Leaf | None, b: Leaf | None, packaged: Units) -> bool:
        if a == b or a is None or b is None or not ('"' in a or '"' in b):
            return a == b
        unit = self.unit(*at, packaged)
        return canonical(at[1], a, unit) == canonical(at[1], b, unit)

    def _part(self, component: str) -> tuple[str, Leaf]:
        paths = self._parts.get(component)
        return self.files[paths[0]].inventory[component] if paths else ("", "")

    def _put(self, path: str, flat: Flat | None) -> None:
        old, new = self.files.pop(path, _NOTHING), flat or _NOTHING
        if flat:
            self.files[path] = flat
        for index, gone, come in (
            (self._states, old.state, new.state),
            (self._parts, old.inventory, new.inventory),
            (self._types, old.units, new.units),
        ):
            for name in gone.keys() - come.keys():
                index[name] = tuple(p for p in index[name] if p != path)
                if not index[name]:
                    del index[name]
            for name in come.keys() - gone.keys():
                # Two files with one component is an error of the lab's; the first by name counts, as when it is read.
                index[name] = tuple(sorted((*index.get(name, ()), path)))


_NOTHING = Flat()


def _touched(old: Flat | None, new: Flat | None) -> Iterator[str]:
    """Yield the components of which two versions of a file say something else."""
    a, b = old or _NOTHING, new or _NOTHING
    yield from (n for n in a.state.keys() | b.state.keys() if a.state.get(n) != b.state.get(n))
    yield from (n for n in a.inventory.keys() | b.inventory.keys() if a.inventory.get(n) != b.inventory.get(n))


def walk(
    steps: Sequence[WalkStep],
    delta: Callable[[str, str | None], Delta],
    packaged: Units,
    known: Mapping[str, Blame] | None = None,
) -> Blame:
    """Return the blame of the last of `steps`, which come parents first; an empty one where there are none.

    `delta` returns how a commit differs from its first parent, or from nothing (None). `known`: the blames of commits
    before the first step, which are used up; a parent that is neither there nor among the steps counts as none. What
    no later step needs is let go at once.
    """
    blames = dict(known or {})
    uses = Counter(parent for step in steps for parent in set(step.parents))
    blame = Blame()
    for step in steps:
        parents = [p for p in dict.fromkeys(step.parents) if p in blames]
        uses.subtract(parents)
        first, *others = [blames[p] if uses[p] else blames.pop(p) for p in parents] or [Blame()]
        blame = first.copy() if parents and uses[parents[0]] else first
        blame.put(delta(step.commit, parents[0] if parents else None), step.commit, packaged, others)
        blames[step.commit] = blame
    return blame
