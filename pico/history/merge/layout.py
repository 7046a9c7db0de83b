"""Three versions of a manifest merged entry by entry, comments included: for what lines can't tell apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pico.history.merge.leaves import Conflict, Path
from pico.history.merge.markers import CLOSE, MIDDLE, OPEN
from pico.manifest.fmt import lines, stripped
from pico.manifest.text.layout import Entry, Layout
from pico.manifest.text.tree import Document

_STATE = frozenset({"components"})
Version = tuple[str, Sequence[Document]]
"""A text without byte order mark, and its documents; none where a version does not exist."""


def merge_layout(
    base: Version, ours: Version, theirs: Version, conflicts: Sequence[Conflict], *, block_style: bool
) -> str:
    """Return the merged text in the normal form of `pico fmt`, lines ended by a line feed.

    The three texts hold the same values wherever those could be merged, and tokens where not. Each conflict over
    entries stands between sentinels. `block_style`: no mapping stays in braces, so that its entries can be merged.
    """
    below = frozenset({"*"}) if block_style else _STATE
    read = [_read(version, below, len(ours[1])) for version in (base, ours, theirs)]
    blocks = []
    split = {(*c.path[:-1], key): (i, c.keys) for i, c in enumerate(conflicts) for key in c.keys}
    for i, ((b_head, b, b_tail), (o_head, o, o_tail), (t_head, t, t_tail)) in enumerate(zip(*read, strict=True)):
        entries = _Merge(split).entries((str(i),), b, o, t)
        head, tail = both(b_head, o_head, t_head), both(b_tail, o_tail, t_tail)
        blocks.append("\n".join([*stripped(head), *lines(entries, 0), *stripped(tail, foot=True)]) + "\n")
    return "---\n".join(blocks)


def _read(version: Version, below: frozenset[str], count: int) -> list[tuple[list[str], list[Entry], list[str]]]:
    content, documents = version
    layout = Layout(content)
    found = []
    for i, document in enumerate(documents):
        head, entries = layout.entries(document, block_style=below)
        tail = layout.tail(entries, len(content)) if i == len(documents) - 1 and entries else []
        found.append((head, entries, tail))
    return found or [([], [], [])] * count


class _Merge:
    def __init__(self, split: Mapping[Path, tuple[int, tuple[str, ...]]]) -> None:
        self.split = split

    def entries(self, path: Path, b: list[Entry], o: list[Entry], t: list[Entry]) -> list[Entry]:
        was, mine, other = ({_name(e): e for e in version} for version in (b, o, t))
        merged: list[Entry] = []
        done: set[str] = set()
        orphans: list[str] = []  # comments that a side added to what the other took out
        for key in ordered(list(was), list(mine), list(other)):
            if key in done:
                continue
            conflict = self.split.get((*path, key))
            if conflict:
                number, keys = conflict
                done |= set(keys)
                new = _variants(number, [mine[k] for k in keys if k in mine], [other[k] for k in keys if k in other])
            else:
                entry, lost = self.entry((*path, key), was.get(key), mine.get(key), other.get(key))
                new = [entry] if entry else []
                orphans += lost
            if new and orphans:
                new = [replace(new[0], lead=[*orphans, *new[0].lead]), *new[1:]]
                orphans = []
            merged += new
        if orphans and merged:
            merged[-1] = replace(merged[-1], foot=[*merged[-1].foot, *orphans])
        return merged

    def entry(
        self, path: Path, b: Entry | None, o: Entry | None, t: Entry | None
    ) -> tuple[Entry | None, Sequence[str]]:
        if o is None or t is None:
            left = o or t
            if left is None or b is None:
                return left, ()
            known = _remarks(b)
            return None, [line for line in _remarks(left) if line not in known]
        if b is None:
            b = Entry(o.key, o.column)
        lead, trail = both(b.lead, o.lead, t.lead), (o.trail, t.trail)
        if t.trail in (o.trail, b.trail):
            kept = o.trail
        elif o.trail == b.trail or not o.trail:
            kept = t.trail
        else:
            kept, above = sorted(trail, reverse=True)
            lead = [*lead, above.strip()] if above else lead
        value, below = self.content(path, b, o, t)
        return replace(o, lead=lead, trail=kept, value=value, below=below, foot=both(b.foot, o.foot, t.foot)), ()

    def content(self, path: Path, b: Entry, o: Entry, t: Entry) -> tuple[str, list[Entry]]:
        if (_mapping(o) and _mapping(t) and not b.value) or _components(b, o, t):
            below = self.entries(path, b.below if _mapping(b) else [], o.below, t.below)
            return "" if below else o.value, below
        was, mine, other = (_text(e) for e in (b, o, t))
        left = t if mine == was else o  # where both changed, the check of the result refuses it
        return left.value, left.below if left is o or mine != other else o.below


def _mapping(entry: Entry) -> bool:
    return bool(entry.below) and all(e.key is not None for e in entry.below)


def _components(*versions: Entry) -> bool:
    """Whether entries are the components of a state, of which a version may have none: `{}`, or nothing."""
    return versions[1].key == "components" and all(_mapping(e) or e.value in ("", "{}", "null") for e in versions)


def _name(entry: Entry) -> str:
    return (entry.key or "").strip("'\"")


def _text(entry: Entry) -> list[str]:
    return [entry.value, *lines(entry.below, 0)]


def _remarks(entry: Entry) -> list[str]:
    own = [*(line for line in entry.lead if line), *([entry.trail.strip()] if entry.trail else []), *entry.foot]
    return [*own, *(line for e in entry.below for line in _remarks(e))]


def _variants(number: int, ours: list[Entry], theirs: list[Entry]) -> list[Entry]:
    """Return what each side has, between sentinels."""
    opened, middle, closed = f"{OPEN}{number}", f"{MIDDLE}{number}", f"{CLOSE}{number}"
    result = [*ours, *theirs]
    first, last = (replace(result[0], lead=[*result[0].lead]), result[-1])
    result[0] = first
    if ours:
        first.lead[:0] = [opened]
        if theirs:
            after = result[len(ours)]
            result[len(ours)] = replace(after, lead=[middle, *after.lead])
            result[-1] = replace(result[-1], foot=[*result[-1].foot, closed])
        else:
            result[-1] = replace(result[-1], foot=[*last.foot, middle, closed])
    else:
        first.lead[:0] = [opened, middle]
        result[-1] = replace(result[-1], foot=[*result[-1].foot, closed])
    return result


def both(base: list[str], ours: list[str], theirs: list[str]) -> list[str]:
    """Return lines of comments merged: what a side added stays, what a side took out goes. Nothing conflicts."""
    if theirs in (ours, base):
        return ours
    if ours == base:
        return theirs
    blank = [""] if "" in (*ours[:1], *theirs[:1]) else []
    kept = [line for line in base if line and line in ours and line in theirs]
    shared = [line for line in ours if line and line not in base and line in theirs]
    added = [[x for x in mine if x and x not in base and x not in shared] for mine in (ours, theirs)]
    return [*blank, *kept, *shared, *(line for block in sorted(added) for line in block)]


def ordered(base: list[str], ours: list[str], theirs: list[str]) -> list[str]:
    """Return the keys of all three in one order, whichever side is called ours.

    Keys of the base stand as the side has them that moved them; a new one follows what it follows on its side, several
    new ones by name. Without a base, what both sides have stands as they have it.
    """
    base = base or [k for k in min(ours, theirs) if k in ours and k in theirs]
    was, mine, other = ([k for k in keys if k in base and k in ours and k in theirs] for keys in (base, ours, theirs))
    result = other if mine == was else mine if other in (was, mine) else was
    new: set[str] = set()
    for key in sorted({*base, *ours, *theirs} - set(result)):
        spot = max(_spot(key, keys, result) for keys in (base, ours, theirs) if key in keys)
        while spot < len(result) and result[spot] in new:
            spot += 1
        result.insert(spot, key)
        new.add(key)
    return result


def _spot(key: str, keys: list[str], result: list[str]) -> int:
    """Return where a key belongs among those that stand already: behind the nearest one before it."""
    before = [k for k in keys[: keys.index(key)] if k in result]
    return result.index(before[-1]) + 1 if before else 0
