"""A document as entries with the comments and blank lines that belong to them, so that entries can change places."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from pico.manifest.text.tree import Document, List, Map, Node, Scalar
from pico.model.state import is_reference

WIDEST = 120
"""A flow collection that was on several lines is put on one where it stays within this width."""
_COMMENT = re.compile(r"(?:^|(?<=[\s]))#[^\r\n]*")
_TRAIL = re.compile(r"(?:[ \t]*,)?([ \t]+)(#[^\r\n]*)")
_LINE = re.compile(r"\r\n|\n|\r")


@dataclass(slots=True)
class Entry:
    """One key with its value, or one item of a list (no key): text on its line, or entries below it.

    `lead`: comments and blank lines above; `trail`: the comment behind, with the space before it; `foot`: comments
    below that are indented deeper than what follows, so that they belong here.
    """

    key: str | None
    column: int
    lead: list[str] = field(default_factory=list)
    trail: str = ""
    value: str = ""
    below: list[Entry] = field(default_factory=list)
    foot: list[str] = field(default_factory=list)


class Layout:
    """Reads the entries of the documents of one text, in its order."""

    def __init__(self, content: str) -> None:
        self.content = content
        self.at = 0

    def entries(self, document: Document, *, block_style: frozenset[str]) -> tuple[list[str], list[Entry]]:
        """Return the comments above a document, and its entries; none below a key of `block_style` stays in flow."""
        root = document.root
        if not isinstance(root, Map):
            return [], []
        first = next(iter(root.entries.values()))[0].start if root.entries else root.end
        head = [line for _, line in self._gap(first)]
        return head, self._map(root, block_style)

    def tail(self, entries: list[Entry], end: int) -> list[str]:
        """Return the comments below the last entry, as far as they don't belong to it."""
        gap = self._gap(end)
        return self._give_foot(entries, gap, 0)

    def _map(self, node: Map, block_style: frozenset[str]) -> list[Entry]:
        entries: list[Entry] = []
        for name, (key, value) in node.entries.items():
            column = self._column(key.start)
            lead = self._lead(entries, key.start, column)
            entry = Entry(self.content[key.start : key.end] or '""', column, lead)
            self.at = key.end
            self._fill(entry, value, frozenset({"*"}) if name in block_style or "*" in block_style else frozenset())
            entries.append(entry)
        return entries

    def _list(self, node: List) -> list[Entry]:
        entries: list[Entry] = []
        for item in node.items:
            dash = item.start if node.flow else self.content.rfind("-", 0, item.start + 1)
            column = self._column(dash)
            entry = Entry(None, column, self._lead(entries, item.start, column))
            self.at = item.start
            self._fill(entry, item, frozenset())
            entries.append(entry)
        return entries

    def _fill(self, entry: Entry, node: Node, block_style: frozenset[str]) -> None:
        if isinstance(node, Scalar):
            entry.lead += [line for _, line in self._gap(max(node.start, self.at)) if line]
            entry.value = _scalar(self.content, node)
            self.at = max(self.at, node.end)
            entry.trail = self._trail()
        elif node.flow and self._stays_flow(node, block_style, entry):
            entry.lead += [line for _, line in self._gap(node.start) if line]
            entry.value = _flow(self.content, node)
            self.at = node.end
            entry.trail = self._trail()
        elif "*" in block_style and isinstance(node, Map) and (line := self._on_one_line(node)):
            entry.lead += [line for _, line in self._gap(node.start) if line]
            entry.value, self.at = line, max(value.end for _, value in node.entries.values())
            entry.trail = self._trail()
        else:
            self._fill_block(entry, node, block_style)

    def _on_one_line(self, node: Map) -> str:
        """Return a set-point that light finds, in block style, as the one line that it is; empty for anything else."""
        if node.flow or not is_reference(node.entries):
            return ""
        texts = {key.text: self.content[value.start : value.end] for key, value in node.entries.values()}
        plain = all(isinstance(value, Scalar) or value.flow for _, value in node.entries.values())
        clean = not any(_LINE.search(text) or "#" in text or not text for text in texts.values())
        end = max(value.end for _, value in node.entries.values())
        if not plain or not clean or any(True for _ in comments(self.content, node.start, end, node)):
            return ""
        return "{" + ", ".join(f"{key}: {text}" for key, text in texts.items()) + "}"

    def _fill_block(self, entry: Entry, node: Map | List, block_style: frozenset[str]) -> None:
        if node.flow:
            entry.lead += [line for _, line in self._gap(node.start) if line]
            self.at = node.start + 1
        elif entry.key is not None:
            self.at = self.content.find(":", self.at, node.start) + 1 or self.at
        if entry.key is not None:
            entry.trail = self._trail()
        entry.below = self._map(node, block_style) if isinstance(node, Map) else self._list(node)
        if node.flow:
            entry.below[-1].foot += [line for _, line in self._gap(node.end) if line]
            self.at = node.end
            trail = self._trail()
            if entry.key is not None and not entry.trail:
                entry.trail = trail
            elif trail:
                entry.foot.append(trail.strip())

    def _stays_flow(self, node: Map | List, block_style: frozenset[str], entry: Entry) -> bool:
        text = self.content[node.start : node.end]
        if not (node.entries if isinstance(node, Map) else node.items):
            return "#" not in text
        if "*" in block_style and isinstance(node, Map) and not is_reference(node.entries):
            return False
        if any(True for _ in comments(self.content, node.start, node.end, node)):
            return False
        width = entry.column + len(entry.key or "") + len(_flow(self.content, node)) + 4
        return not _LINE.search(text) or width <= WIDEST

    def _lead(self, before: list[Entry], start: int, column: int) -> list[str]:
        gap = self._gap(start)
        lead = self._give_foot(before, gap, column) if before else [line for _, line in gap]
        if not before:
            while lead and not lead[0]:
                lead.pop(0)
        return lead

    def _give_foot(self, entries: list[Entry], gap: list[tuple[int, str]], column: int) -> list[str]:
        """Give comments that are indented deeper than `column` to the last entry, and return the others."""
        deeper = 0
        for i, (indent, line) in enumerate(gap):
            if line and indent <= column:
                break
            if line:
                deeper = i + 1
        feet, rest = [g for g in gap[:deeper] if g[1]], gap[deeper:]
        last = entries[-1]
        while feet and last.below and feet[0][0] > last.below[-1].column:
            down = [g for g in feet if g[0] > last.below[-1].column]
            keep = feet[len(down) :] if feet[: len(down)] == down else None
            if keep:
                last.foot += [line for _, line in keep]
                feet = down
            last = last.below[-1]
        last.foot += [line for _, line in feet]
        return [line for _, line in rest]

    def _gap(self, end: int) -> list[tuple[int, str]]:
        """Return the comments, with their columns, and blank lines ('') from here to `end`, and go there."""
        start, self.at = self.at, max(self.at, end)
        found: list[tuple[int, str]] = []
        lines = _LINE.split(self.content[start:end])
        for i, line in enumerate(lines):
            comment = _COMMENT.search(line)
            if comment:
                found.append((comment.start() + (self._column(start) if i == 0 else 0), comment[0].rstrip()))
            elif not line.strip() and 0 < i < len(lines) - 1 and (not found or found[-1][1]):
                found.append((0, ""))
        return found

    def _trail(self) -> str:
        match = _TRAIL.match(self.content, self.at)
        if not match:
            return ""
        self.at = match.end()
        return match[1].replace("\t", " ") + match[2].rstrip()

    def _column(self, index: int) -> int:
        return index - max(self.content.rfind("\n", 0, index), self.content.rfind("\r", 0, index)) - 1


def comments(content: str, start: int, end: int, *nodes: Node) -> Iterator[str]:
    """Yield the comments in [start, end), a stretch that `nodes` cover."""
    at = start
    spans = sorted((s.start, s.end) for node in nodes for s in _leaves(node))
    for first, last in [*spans, (end, end)]:
        for match in _COMMENT.finditer(content[at:first]):
            yield match[0].rstrip()
        at = max(at, last)


def _leaves(node: Node) -> Iterator[Scalar]:
    if isinstance(node, Scalar):
        yield node
        return
    children = node.items if isinstance(node, List) else [n for pair in node.entries.values() for n in pair]
    for child in children:
        yield from _leaves(child)


def _scalar(content: str, node: Scalar) -> str:
    """A scalar as it stands; on one line where it was folded over several without need."""
    text = content[node.start : node.end]
    if node.style in ("|", ">"):
        return _literal(node, text)
    if not _LINE.search(text):
        return text
    return node.text if not node.style and "\n" not in node.text else json.dumps(node.text, ensure_ascii=False)


def _literal(node: Scalar, text: str) -> str:
    """A block scalar without its indentation, for the writer to indent; quoted where that can't be told."""
    header, *lines = _LINE.split(text.rstrip())
    first = next((line for line in lines if line.strip()), "")
    plain_header = re.fullmatch(r"[|>]-?([ \t]+#.*)?", header)
    if not plain_header or not first or not lines[0].strip() or "\t" in first[: len(first) - len(first.lstrip())]:
        return json.dumps(node.text, ensure_ascii=False)
    indent = len(first) - len(first.lstrip(" "))
    return "\n".join([header.rstrip(), *(line[indent:] if line.strip() else "" for line in lines)])


def _flow(content: str, node: Node) -> str:
    if isinstance(node, Scalar):
        return _scalar(content, node)
    if isinstance(node, List):
        return "[" + ", ".join(_flow(content, item) for item in node.items) + "]"
    pairs = (f"{_flow(content, key)}: {_flow(content, value)}".rstrip() for key, value in node.entries.values())
    return "{" + ", ".join(pairs) + "}"
