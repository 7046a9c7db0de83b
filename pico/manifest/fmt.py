"""`pico fmt`: one way to lay a manifest out, so that diffs show what changed and nothing else. Comments stay."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

from pico.diagnostics import PicoError, error
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.layout import Entry, Layout, comments
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, parse

_HEADER = {"apiVersion": 0, "kind": 1, "metadata": 2}
_STATE = {**_HEADER, "components": 3, "expect": 4}
_POSE = {"x": 0, "y": 1, "yaw": 2}
_PLACE = {"slot": 0, "pose": 1}
_STEP = 2


def format_text(text: str, path: str = "manifest") -> str:
    """Return a manifest in its normal form: two spaces a level, components and tunables by name, one tunable a line.

    What the manifest says, its comments and its line ends stay. Text that is not PICO's is returned as it is. Raises
    PicoError for text that is not valid YAML; its diagnostics name `path`.
    """
    content = text.removeprefix("\ufeff")
    documents, found = parse(Source(path, content))
    if found:
        raise PicoError(found)
    if not documents or any(kind_of(d)[0] is None or not isinstance(d.root, Map) for d in documents):
        return text
    result = _documents(content, documents)
    _verify(content, documents, result)
    newline = re.search(r"\r\n|\n", content)
    return result.replace("\n", newline[0]) if newline else result


def _documents(content: str, documents: list[Document]) -> str:
    layout = Layout(content)
    blocks: list[str] = []
    for i, document in enumerate(documents):
        state = kind_of(document)[0] == "LabState"
        head, entries = layout.entries(document, block_style=frozenset({"components"} if state else ()))
        tail = layout.tail(entries, len(content)) if i == len(documents) - 1 else []
        text = stripped(head) + lines(_in_order(entries, state), 0) + stripped(tail, foot=True)
        blocks.append("\n".join(text) + "\n")
    return "---\n".join(blocks)


def stripped(text: list[str], *, foot: bool = False) -> list[str]:
    """Return lines without the blank ones at the end, and, unless it is a `foot`, at the beginning."""
    while text and not text[-1]:
        text = text[:-1]
    while text and not text[0] and not foot:
        text = text[1:]
    return text


def _in_order(entries: list[Entry], state: bool) -> list[Entry]:
    ranks = _STATE if state else _HEADER
    entries = sorted(entries, key=lambda e: ranks.get(_name(e), 9))
    for entry in entries:
        if state and entry.key is not None and _name(entry) == "components":
            entry.below = sorted(entry.below, key=_name)
            for component in entry.below:
                component.below = sorted(component.below, key=lambda e: (_PLACE.get(_name(e), 2), _name(e)))
    for entry in entries:
        _order_poses(entry)
    return entries


def _order_poses(entry: Entry) -> None:
    if entry.key is not None and _name(entry) == "pose" and {_name(e) for e in entry.below} <= _POSE.keys():
        entry.below = sorted(entry.below, key=lambda e: _POSE[_name(e)])
    for below in entry.below:
        _order_poses(below)


def _name(entry: Entry) -> str:
    return (entry.key or "").strip("'\"")


def lines(entries: list[Entry], indent: int) -> list[str]:
    """Return the lines of entries in the normal form, `indent` spaces deep."""
    text: list[str] = []
    for i, entry in enumerate(entries):
        lead = entry.lead if i else stripped(entry.lead[:1]) + entry.lead[1:]  # no blank line above the first
        text += [f"{' ' * indent}{line}" if line else "" for line in lead]
        text += _item(entry, indent) if entry.key is None else _entry(entry, indent)
        text += [f"{' ' * (indent + _STEP)}{line}" for line in entry.foot]
    return text


def _entry(entry: Entry, indent: int) -> list[str]:
    pad = " " * indent
    if entry.below:
        return [f"{pad}{entry.key}:{entry.trail}", *lines(entry.below, indent + _STEP)]
    first, *more = entry.value.split("\n")
    head = f"{pad}{entry.key}: {first}" if first else f"{pad}{entry.key}:"
    return [head + entry.trail, *(f"{pad}  {line}" if line else "" for line in more)]


def _item(entry: Entry, indent: int) -> list[str]:
    pad = " " * indent
    if entry.below:
        first, *more = lines(entry.below, indent + _STEP)
        return [f"{pad}- {first.lstrip(' ')}", *more]
    first, *more = entry.value.split("\n")
    return [f"{pad}- {first}".rstrip() + entry.trail, *(f"{pad}  {line}" if line else "" for line in more)]


def _verify(content: str, documents: list[Document], result: str) -> None:
    again, found = parse(Source("manifest", result))
    same = not found and [_leaves(d.root) for d in again] == [_leaves(d.root) for d in documents]
    if not same or _remarks(content, documents) != _remarks(result, again):
        hint = "move comments that stand inside of values to lines of their own"
        raise PicoError(error("fmt", "this manifest can't be laid out without losing something", hint=hint))


def _remarks(content: str, documents: list[Document]) -> Counter[str]:
    return Counter(comments(content, 0, len(content), *(d.root for d in documents)))


def _leaves(node: Node) -> Any:
    """A node as data in which 1, 1.0 and "1" differ, so that nothing changes its type."""
    if isinstance(node, Scalar):
        return type(node.value), node.value
    if isinstance(node, List):
        return [_leaves(item) for item in node.items]
    return {key: _leaves(value) for key, (_, value) in node.entries.items()}
