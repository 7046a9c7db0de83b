"""Small edits of YAML text at the marks of its parsed document: everything else stays byte for byte as it was."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pico.manifest.text.scalars import resolve
from pico.manifest.text.tree import Document, List, Map, Node, Scalar
from pico.model.state import is_reference

_BARE = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*")
_BREAK = re.compile(r"\r\n|\n|\r")
_LINE = re.compile(r"[^\r\n]*(?:\r\n|\n|\r)|[^\r\n]+")


@dataclass(frozen=True, slots=True)
class Splice:
    """Replaces the characters [start, end) by `text`."""

    start: int
    end: int
    text: str


def apply_splices(content: str, splices: list[Splice]) -> str:
    """Return `content` with splices applied; those at one place in the order in which they were made."""
    parts, last = [], 0
    for splice in sorted(splices, key=lambda s: s.start):
        parts += [content[last : splice.start], splice.text]
        last = max(last, splice.end)
    return "".join([*parts, content[last:]])


def write_scalar(value: Any) -> str:
    """Return a value as a manifest holds it: whole numbers without a point, text without quotes where that is safe."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        number = float(value)
        return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)
    text = str(value)
    return text if _BARE.fullmatch(text) and isinstance(resolve(text), str) else json.dumps(text, ensure_ascii=False)


def write_flow(value: Any) -> str:
    """Return a value, or a mapping or a list of values, on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {write_flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(write_flow(inner) for inner in value) + "]"
    return write_scalar(value)


def write_block(key: str, value: Any, indent: int, step: int) -> list[str]:
    """Return the lines of an entry, its mappings in block style, but for a set-point that light finds."""
    if isinstance(value, Mapping) and value and not is_reference(value):
        inner = [line for k, v in value.items() for line in write_block(k, v, indent + step, step)]
        return [f"{' ' * indent}{key}:", *inner]
    return [f"{' ' * indent}{key}: {write_flow(value)}"]


class Editor:
    """Collects the splices of one document."""

    def __init__(self, document: Document) -> None:
        self.source = document.source
        self.content = document.source.content
        first = _BREAK.search(self.content)
        self.newline = first[0] if first else "\n"
        self.splices: list[Splice] = []

    def column(self, node: Node) -> int:
        """Return how far a node is indented."""
        return self.source.position(node.start).column - 1

    def step(self, key: Node, parent: Node) -> int:
        """Return how much deeper the entries of a block mapping stand than its key."""
        if isinstance(parent, Map) and parent.entries and not parent.flow:
            return max(1, self.column(next(iter(parent.entries.values()))[0]) - self.column(key))
        return 2

    def set_scalar(self, key: Scalar, node: Node, value: Any) -> None:
        """Give an existing entry another value."""
        text = write_flow(value)
        if not isinstance(node, Scalar):
            self.splices.append(Splice(self._colon(key, node), self.end(key, node), f" {text}"))
        elif node.start == node.end:
            colon = self._colon(key, node)
            self.splices.append(Splice(colon, colon, f" {text}"))
        else:
            ending = self.newline if node.style in ("|", ">") else ""
            self.splices.append(Splice(node.start, node.end, _as_before(node, value, text) + ending))

    def replace(self, key: Scalar, node: Node, new_key: str, value: Any, *, flow: bool, step: int) -> None:
        """Put another entry in the place of an existing one."""
        if flow:
            text = f"{new_key}: {write_flow(value)}"
        else:
            lines = write_block(new_key, value, self.column(key), step)
            text = self.newline.join(lines).lstrip(" ")
        ending = self.newline if isinstance(node, Scalar) and node.style in ("|", ">") else ""
        self.splices.append(Splice(key.start, self.end(key, node), text + ending))

    def remove(self, parent: Map, name: str) -> None:
        """Take an entry out, with its line in block style."""
        key, node = parent.entries[name]
        if not parent.flow:
            self.splices.append(Splice(*self._lines(key, node), ""))
            return
        names = list(parent.entries)
        index = names.index(name)
        if index + 1 < len(names):
            self.splices.append(Splice(key.start, parent.entries[names[index + 1]][0].start, ""))
        else:
            before = self.end(*parent.entries[names[index - 1]]) if index else parent.start + 1
            self.splices.append(Splice(before, self.end(key, node), ""))

    def block(self, key: Scalar, parent: Map, name: str) -> tuple[int, int]:
        """Return where an entry of the block mapping `parent` of `key` stands: whole lines, with the comments above it,
        and those below that are indented deeper than it."""
        names = list(parent.entries)
        index = names.index(name)
        start = self.below(key, parent, names[index - 1] if index else None)
        return start, self.below(key, parent, name)

    def below(self, key: Scalar, parent: Map, name: str | None) -> int:
        """Return where the lines end that belong to an entry of the block mapping `parent` of `key`; None: to the key
        itself."""
        if name is None:
            return self._next_line(self._line_end(key.end))
        at = self._lines(*parent.entries[name])[1]
        column, found = self.column(parent.entries[name][0]), at
        while line := _LINE.match(self.content, at):
            at, text = line.end(), line[0].lstrip(" ")
            if text.strip() and (not text.startswith("#") or len(line[0]) - len(text) <= column):
                break
            found = at if text.strip() else found
        return found

    def _lines(self, key: Scalar, node: Node) -> tuple[int, int]:
        """Return where the lines of an entry in block style begin and end."""
        return self.content.rfind("\n", 0, key.start) + 1, self._next_line(self._after(key, node)[0])

    def insert(
        self,
        key: Scalar | None,
        parent: Node,
        entries: Mapping[str, Any],
        order: Callable[[str], Any],
        *,
        flow: bool,
        leaving: frozenset[str] = frozenset(),
    ) -> None:
        """Put new entries into the mapping `parent` of `key` (None: the root), each before the first one that sorts
        after it. `flow`: what holds the mapping is in flow style. Entries in `leaving` are no neighbors."""
        old = parent.entries if isinstance(parent, Map) else {}
        if old and isinstance(parent, Map) and parent.flow:
            self._insert_flow(parent, entries, order)
        elif flow:
            start = self._colon(key, parent) if key else parent.start
            self.splices.append(
                Splice(start, max(start, self.end(key, parent) if key else parent.end), f" {write_flow(entries)}")
            )
        else:
            self._insert_block(key, parent, entries, order, leaving)

    def _insert_flow(self, parent: Map, entries: Mapping[str, Any], order: Callable[[str], Any]) -> None:
        for name in sorted(entries, key=order):
            text = f"{name}: {write_flow(entries[name])}"
            before = _before(parent, name, order, frozenset())
            if before is None:
                self.splices.append(Splice(parent.start + 1, parent.start + 1, f"{text}, "))
            else:
                end = self.end(*parent.entries[before])
                self.splices.append(Splice(end, end, f", {text}"))

    def _insert_block(
        self,
        key: Scalar | None,
        parent: Node,
        entries: Mapping[str, Any],
        order: Callable[[str], Any],
        leaving: frozenset[str],
    ) -> None:
        filled = isinstance(parent, Map) and bool(parent.entries)
        if isinstance(parent, Map) and filled:
            indent = self.column(next(iter(parent.entries.values()))[0])
            step = next((self.step(k, v) for k, v in parent.entries.values() if isinstance(v, Map) and not v.flow), 2)
        else:
            indent, step = (self.column(key) + 2 if key else 0), 2
            if key and parent.end > parent.start:  # `{}` or `null` makes room for lines
                self.splices.append(Splice(self._colon(key, parent), parent.end, ""))
        for name in sorted(entries, key=order):
            before = _before(parent, name, order, leaving) if isinstance(parent, Map) and filled else None
            if isinstance(parent, Map) and before is not None:
                at, open_line = self._after(*parent.entries[before])
            elif key:
                at, open_line = (
                    self._line_end(parent.end if parent.end > parent.start and not filled else key.end),
                    True,
                )
            else:
                at, open_line = self.content.rfind("\n", 0, parent.start) + 1, False
            lines = self.newline.join(write_block(name, entries[name], indent, step))
            self.splices.append(Splice(at, at, self.newline + lines if open_line else lines + self.newline))

    def end(self, key: Scalar, node: Node) -> int:
        """Return where the text of an entry ends: after its last scalar or closing bracket."""
        while True:
            if isinstance(node, Scalar):
                return self._colon(key, node) if node.start == node.end else node.end
            if node.flow:
                return node.end
            if isinstance(node, Map):
                key, node = list(node.entries.values())[-1]
            elif isinstance(node.items[-1], Scalar | List) or node.items[-1].flow:
                node = node.items[-1]
            else:
                key, node = list(node.items[-1].entries.values())[-1]

    def _after(self, key: Scalar, node: Node) -> tuple[int, bool]:
        """Where a line may be put after an entry, and whether the line there is still open."""
        end = self.end(key, node)
        if end and self.content[end - 1] in "\r\n":  # a block scalar ends with its last line break
            return end, False
        return self._line_end(end), True

    def _line_end(self, index: int) -> int:
        found = _BREAK.search(self.content, index)
        return found.start() if found else len(self.content)

    def _next_line(self, index: int) -> int:
        if index and self.content[index - 1] in "\r\n":
            return index
        found = _BREAK.match(self.content, index)
        return found.end() if found else index

    def _colon(self, key: Scalar, node: Node) -> int:
        """Return where the value of an entry may begin: after its colon."""
        colon = self.content.find(":", key.end, max(node.start, key.end) + 1)
        return colon + 1 if colon >= 0 else key.end


def _before(parent: Map, name: str, order: Callable[[str], Any], leaving: frozenset[str]) -> str | None:
    before = None
    for other in parent.entries:
        if other in leaving:
            continue
        if order(other) > order(name):
            break
        before = other
    return before


def _as_before(node: Scalar, value: Any, text: str) -> str:
    """Keep a decimal point where the number had one: 90.0 becomes 1.0, not 1."""
    if isinstance(value, float | int) and not node.style and re.fullmatch(r"-?\d+\.0+", node.text) and "." not in text:
        return text + ".0" if re.fullmatch(r"-?\d+", text) else text
    return text
