"""What differs physically between two versions of one manifest, read leniently: a diff must also show what is wrong."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pico.history.diff.surroundings import Surroundings, at, text
from pico.history.merge.leaves import canonical, leaves, shown
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, parse, plain
from pico.model.catalog import Tunable
from pico.model.diff import Change, describe_move, describe_value
from pico.model.pose import Pose
from pico.model.quantities import QuantityError, convert
from pico.model.record import as_json
from pico.model.state import is_reference

_PLACE = ("slot", "pose")


@dataclass(frozen=True, slots=True)
class FileDiff:
    """The components and tunables of a state that differ, and the other values: (sign, address, what), sign `+-~`.

    Both are empty where the two versions say the same in other words: comments, order, layout.
    """

    changes: tuple[Change, ...] = ()
    others: tuple[tuple[str, str, str], ...] = ()


def diff_files(old: bytes, new: bytes, path: Path) -> FileDiff | None:
    """Return what differs between two versions of the manifest at `path`, either of which may be empty.

    None where a version is no valid YAML within the limits, or neither is a manifest: then lines tell more.
    """
    before, after = _documents(old), _documents(new)
    if before is None or after is None or not _manifests([*before, *after]):
        return None
    if len(before) != len(after) and before and after:
        return None
    around = Surroundings(path)
    changes: list[Change] = []
    others: list[tuple[str, str, str]] = []
    for i in range(max(len(before), len(after))):
        a, b = (documents[i].root if documents else Map(0, False) for documents in (before, after))
        states = [node for node in (a, b) if text(node, "kind") == "LabState"]
        if states:
            changes += _components(at(a, "components"), at(b, "components"), around)
            others += _others(a, b, ("components",) if at(a, "kind") and at(b, "kind") else ("components", "metadata"))
        else:
            others += _others(a, b, ())
    return FileDiff(tuple(changes), tuple(others))


def _documents(data: bytes) -> list[Document] | None:
    if not data.strip():
        return []
    source, _ = decode("manifest", data)
    if source is None:
        return None
    documents, wrong = parse(source)
    return None if wrong else documents


def _manifests(documents: Sequence[Document]) -> bool:
    return bool(documents) and all(kind_of(d)[0] for d in documents)


def _components(a: Node | None, b: Node | None, around: Surroundings) -> Iterator[Change]:
    old, new = (node.entries if isinstance(node, Map) else {} for node in (a, b))
    for name in sorted(old.keys() | new.keys()):
        if name not in new:
            home = around.home(name)
            said = f"taken out of this file (its home: {home})" if home else "taken out of this file"
            yield Change(component=name, tunable="pose", before=_where(old[name][1]), text=said)
        elif name not in old:
            yield from _added(name, new[name][1], around)
        else:
            yield from _changed(name, old[name][1], new[name][1], around)


def _added(name: str, node: Node, around: Surroundings) -> Iterator[Change]:
    place = _where(node)
    where = f": in {place}" if isinstance(place, str) else f": at {_pose(at(node, 'pose'))}" if place else ""
    yield Change(component=name, tunable="pose", after=place, text=f"added{where}")
    yield from _values(name, None, node, around)


def _changed(name: str, a: Node, b: Node, around: Surroundings) -> Iterator[Change]:
    if _location(a) != _location(b):
        yield Change(component=name, tunable="pose", before=_where(a), after=_where(b), text=_moved(a, b))
    yield from _values(name, a, b, around)


def _location(node: Node) -> Any:
    """Return slot and pose as data that compares as the table does: 12 mm is 1.2 cm, and no yaw is a yaw of 0."""
    pose = at(node, "pose")
    return canonical(at(node, "slot")), _pose(pose) or canonical(pose)


def _moved(a: Node, b: Node) -> str:
    slots, poses = [text(n, "slot") or None for n in (a, b)], [_pose(at(n, "pose")) for n in (a, b)]
    known = [bool(slot) != bool(pose) for slot, pose in zip(slots, poses, strict=True)]
    if all(known):
        return describe_move(slots[0], poses[0] or Pose(0, 0), slots[1], poses[1] or Pose(0, 0))
    return f"{_place_text(a)} → {_place_text(b)}"


def _place_text(node: Node) -> str:
    found = [f"{key} {shown(at(node, key))}" for key in _PLACE if at(node, key) is not None]
    return " and ".join(found) or "no place given"


def _where(node: Node) -> Any:
    pose = _pose(at(node, "pose"))
    return text(node, "slot") or (as_json(pose) if pose else None)


def _pose(node: Node | None) -> Pose | None:
    """Return a pose [mm, deg], None where it is none."""
    numbers = [_number(at(node, axis), unit) for axis, unit in (("x", "mm"), ("y", "mm"), ("yaw", "deg"))]
    x, y, yaw = numbers
    if x is None or y is None or (yaw is None and at(node, "yaw") is not None):
        return None
    odd = isinstance(node, Map) and node.entries.keys() - {"x", "y", "yaw"}
    return None if odd else Pose(x, y, yaw or 0.0)


def _number(node: Node | None, unit: str) -> float | None:
    value = _converted(node, unit)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _converted(node: Node | None, unit: str) -> Any:
    """Return the value of a scalar, text with a unit as a number in `unit` where it is one."""
    value = plain(node) if node is not None else None
    try:
        return convert(value, unit) if unit and isinstance(node, Scalar) else value
    except QuantityError:
        return value


def _values(name: str, a: Node | None, b: Node, around: Surroundings) -> Iterator[Change]:
    old, new = (node.entries if isinstance(node, Map) else {} for node in (a, b))
    for tunable in sorted((old.keys() | new.keys()) - set(_PLACE)):
        before, after = at(a, tunable), at(b, tunable)
        if before is not None and after is not None and canonical(before) == canonical(after):
            continue
        unit = around.unit(name, tunable)
        values = [_value(node, unit) for node in (before, after)]
        if before is not None and after is not None and _same(values[0]) == _same(values[1]):
            continue
        said = describe_value(Tunable(unit=unit), *values)
        if after is None:
            said = f"not given any more (was {said.partition(' → ')[0]})"
        elif before is None:
            said = f"set to {said.partition(' → ')[2]}"
        yield Change(component=name, tunable=tunable, before=values[0], after=values[1], text=said)


def _same(value: Any) -> Any:
    """Return a value so that 1 equals 1.0, but neither "1" nor true."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return ("number", float(value)) if number else (type(value).__name__, value)


def _value(node: Node | None, unit: str) -> Any:
    if isinstance(node, Scalar):
        value = _converted(node, unit)
        return "null" if value is None else value
    data = plain(node) if isinstance(node, Map) else None
    return data if is_reference(data) else None if node is None else shown(node)


def _others(a: Node, b: Node, skip: tuple[str, ...]) -> Iterator[tuple[str, str, str]]:
    """Yield the values outside the components that differ."""
    old, new = ({p: n for p, n in leaves(node) if p and p[0] not in skip} for node in (a, b))
    if "kind" in {p[0] for p in old.keys() & new.keys()} and canonical(at(a, "kind")) != canonical(at(b, "kind")):
        yield "~", "kind", f"{shown(at(a, 'kind'))} → {shown(at(b, 'kind'))}"
        return
    header = {("apiVersion",), ("kind",)} if not old or not new else set()
    for path in sorted((old.keys() | new.keys()) - header):
        before, after = old.get(path), new.get(path)
        if path == ("expect",) or (before is not None and after is not None and canonical(before) == canonical(after)):
            continue
        address = ".".join(path)
        if before is None:
            yield "+", address, shown(after)
        elif after is None:
            yield "-", address, shown(before)
        else:
            yield "~", address, f"{shown(before)} → {shown(after)}"
    yield from _expectations(old.get(("expect",)), new.get(("expect",)))


def _expectations(a: Node | None, b: Node | None) -> Iterator[tuple[str, str, str]]:
    old, new = ([*node.items] if isinstance(node, List) else [] for node in (a, b))
    was, now = [canonical(n) for n in old], [canonical(n) for n in new]
    for sign, items, other in (("-", old, now), ("+", new, was)):
        for item in items:
            if canonical(item) not in other:
                yield sign, "expects", text(item, "that") or shown(item)
