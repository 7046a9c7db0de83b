"""The three-way merge of manifests: values one by one, comments of both sides kept, lines for the rest.

The winners are written into all three texts, which then differ in structure and comments only; git merges those line by
line. What comes out is parsed and must say what the merge of the values says, else entries are merged instead of lines,
else the whole file is in conflict. Nothing is lost in silence.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from pico.diagnostics import PicoError
from pico.history.merge.layout import merge_layout
from pico.history.merge.leaves import (
    Conflict,
    Coupled,
    Groups,
    MergedLeaves,
    Path,
    canonical,
    leaves,
    merge_leaves,
    single,
)
from pico.history.merge.lines import merge_lines
from pico.history.merge.markers import OPEN, Labels, has_token, token, view, written
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.layout import comments
from pico.manifest.text.source import Source
from pico.manifest.text.splice import Splice, apply_splices
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, parse

_BOM = "\ufeff"


@dataclass(frozen=True, slots=True)
class Merged:
    """The merged file; with markers unless `clean`. `conflicts` has none where lines, not values, are in conflict."""

    data: bytes
    clean: bool
    conflicts: tuple[Conflict, ...] = ()
    coupled: tuple[Coupled, ...] = ()


@dataclass(frozen=True)
class _Version:
    text: str
    documents: Sequence[Document]
    roots: Sequence[Map] = ()


@dataclass
class _Plan:
    """The three versions made alike, the values of each conflict as both sides write them, and what must come out."""

    base: _Version
    ours: _Version
    theirs: _Version
    values: dict[int, tuple[str, str]]
    outcome: MergedLeaves
    remarks: Counter[str] = field(default_factory=Counter)


def merge(
    base: bytes | None,
    ours: bytes,
    theirs: bytes,
    *,
    labels: Labels = Labels(),  # noqa: B008 (frozen)
    groups: Groups | None = None,
    strict: bool = False,
) -> Merged:
    """Return two versions of a file merged over their common base, None where there is none.

    Values that one side changed are taken from it; those that both changed to different ones conflict. `groups`: by
    component, tunables that mean something only together: changed by both sides in part, they are reported as coupled,
    or conflict where `strict`. A file that is no valid manifest on all sides is merged line by line. Raises PicoError
    where there is no git.
    """
    if ours == theirs:
        return Merged(ours, clean=True)
    versions = _versions(base or b"", ours, theirs)
    if versions is None:
        return _by_lines(base or b"", ours, theirs, labels)
    was, mine, other = versions
    outcome = merge_leaves(was.roots or [None] * len(mine.roots), mine.roots, other.roots, groups or {}, strict=strict)
    plan = _alike(was, mine, other, outcome)
    newline = "\r\n" if "\r\n" in mine.text else "\n"
    mark = _BOM if ours.startswith(_BOM.encode()) else ""
    for text in _candidates(plan, labels):
        lined = text.replace("\r\n", "\n").replace("\n", newline)
        result = written(lined, outcome.conflicts, plan.values, labels, newline)
        if _right(result, plan, labels.size):
            found = tuple(outcome.conflicts)
            return Merged((mark + result).encode(), not found, found, tuple(outcome.coupled))
    return Merged(_whole(ours, theirs, labels), False, tuple(outcome.conflicts), tuple(outcome.coupled))


def _versions(base: bytes, ours: bytes, theirs: bytes) -> tuple[_Version, _Version, _Version] | None:
    """Return three versions of a manifest, or None where they are not all valid, or not of the same kind."""
    mine, other = _read(ours), _read(theirs)
    was = _read(base) if base.strip() else _Version("", [])
    if mine is None or other is None or was is None or len(mine.roots) != len(other.roots):
        return None
    if was.roots and len(was.roots) != len(mine.roots):
        return None
    kinds = {tuple(kind_of(d)[0] for d in v.documents) for v in (was, mine, other) if v.documents}
    return (was, mine, other) if len(kinds) == 1 and None not in kinds.pop() else None


def _read(data: bytes) -> _Version | None:
    source, _ = decode("manifest", data)
    if source is None or has_token(source.content):
        return None
    return _parsed(source.content)


def _parsed(text: str) -> _Version | None:
    documents, wrong = parse(Source("manifest", text))
    roots = [d.root for d in documents if isinstance(d.root, Map)]
    return _Version(text, documents, roots) if not wrong and roots and len(roots) == len(documents) else None


def _by_lines(base: bytes, ours: bytes, theirs: bytes, labels: Labels) -> Merged:
    data, clean = merge_lines(base, ours, theirs, labels)
    text = data.decode(errors="replace")
    broken = not all(_valid(view(text, side, labels.size).encode()) for side in ("ours", "theirs"))
    if broken and _valid(ours) and _valid(theirs):
        return Merged(_whole(ours, theirs, labels), False)
    return Merged(data, clean)


def _valid(data: bytes) -> bool:
    source, _ = decode("file", data)
    return source is not None and not parse(source)[1]


def _whole(ours: bytes, theirs: bytes, labels: Labels) -> bytes:
    """Return both versions as a whole, between markers."""
    end = b"\r\n" if b"\r\n" in ours else b"\n"
    mine, other = (data if data.endswith(b"\n") or not data else data + end for data in (ours, theirs))
    opened, middle, closed = (sign * labels.size for sign in ("<", "=", ">"))
    parts = [f"{opened} {labels.ours}".encode() + end, mine, middle.encode() + end, other]
    return b"".join([*parts, f"{closed} {labels.theirs}".encode() + end])


def _alike(was: _Version, mine: _Version, other: _Version, outcome: MergedLeaves) -> _Plan:
    """Write what wins into all three versions wherever a value stands in both sides; a token where none wins."""
    at = [_leaves(v) for v in (was, mine, other)]
    numbers = {c.path: i for i, c in enumerate(outcome.conflicts) if not c.keys}
    splices: list[list[Splice]] = [[], [], []]
    values: dict[int, tuple[str, str]] = {}
    apart = {(*c.path[:-1], key) for c in outcome.conflicts for key in c.keys}  # each side keeps what it has there
    for path in at[1].keys() & at[2].keys():
        if any(path[: len(above)] == above for above in apart):
            continue
        nodes = [leaf.get(path) for leaf in at]
        raw = [_raw(v.text, node) for v, node in zip((was, mine, other), nodes, strict=True)]
        if raw[1] is None or raw[2] is None or (nodes[0] is not None and raw[0] is None):
            continue
        number = numbers.get(path)
        if number is not None:
            values[number] = (raw[1], raw[2])
        wins = token(number) if number is not None else _winner(nodes, raw)
        for made, node in zip(splices, nodes, strict=True):
            if node is not None:
                made.append(Splice(node.start, node.end, wins))
    texts = [apply_splices(v.text, made) for v, made in zip((was, mine, other), splices, strict=True)]
    alike = [_parsed(text) or v for text, v in zip(texts, (was, mine, other), strict=True)]
    plan = _Plan(alike[0], alike[1], alike[2], values, outcome)
    remarks = [_remarks(v) for v in (was, mine, other)]
    plan.remarks = Counter({c: _kept(*(r[c] for r in remarks)) for c in remarks[1].keys() | remarks[2].keys()})
    return plan


def _leaves(version: _Version) -> dict[Path, Node]:
    return {path: node for i, root in enumerate(version.roots) for path, node in leaves(root, (str(i),))}


def _raw(text: str, node: Node | None) -> str | None:
    """Return a value as it is written, None where it does not stand on one line by itself."""
    line = isinstance(node, Scalar) and node.style not in ("|", ">") and node.end > node.start and not node.tag
    if node is None or not (line or (isinstance(node, List) and node.flow) or (isinstance(node, Map) and single(node))):
        return None
    raw = text[node.start : node.end]
    return raw if "\n" not in raw and "\r" not in raw else None


def _winner(nodes: list[Node | None], raw: list[str | None]) -> str:
    """Return the text of a value that does not conflict; the same whichever side is called ours."""
    was, mine, other = (canonical(node) for node in nodes)
    _, ours, theirs = raw
    assert ours is not None and theirs is not None
    if mine != other:
        return theirs if mine == was else ours
    if raw[0] in (ours, theirs):
        return theirs if ours == raw[0] else ours
    return min(ours, theirs)


def _candidates(plan: _Plan, labels: Labels) -> Iterator[str]:
    """Yield merged texts with tokens and sentinels, the one first that changes least."""
    was, mine, other = (v.text.encode() for v in (plan.base, plan.ours, plan.theirs))
    data, clean = merge_lines(was, mine, other, labels)
    structural = any(c.keys for c in plan.outcome.conflicts)
    if clean and not structural:
        yield data.decode()
    versions = [(v.text, v.documents) for v in (plan.base, plan.ours, plan.theirs)]
    for block_style in (False, True):
        try:
            yield merge_layout(versions[0], versions[1], versions[2], plan.outcome.conflicts, block_style=block_style)
        except (PicoError, IndexError, ValueError):  # a layout that can't be taken apart
            continue


def _right(text: str, plan: _Plan, size: int) -> bool:
    """Whether a result says what it must, resolved for either side, and has lost no comment."""
    if OPEN[0] in text:
        return False
    held: Counter[str] = Counter()
    for side, wanted in (("ours", plan.outcome.ours), ("theirs", plan.outcome.theirs)):
        version = _parsed(view(text, "ours" if side == "ours" else "theirs", size))
        if version is None or [canonical(root) for root in version.roots] != wanted:
            return False
        held |= _remarks(version)
    return all(held[comment] >= times for comment, times in plan.remarks.items())


def _remarks(version: _Version) -> Counter[str]:
    roots: Sequence[Any] = version.roots
    return Counter(comments(version.text, 0, len(version.text), *roots))


def _kept(was: int, mine: int, other: int) -> int:
    """Return how often a comment must be there after the merge, from how often the versions have it."""
    if min(mine, other) >= was:
        return max(mine, other)
    return max(0, min(mine, other) if max(mine, other) <= was else mine + other - was)
