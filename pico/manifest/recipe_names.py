"""A recipe that calls parts of the bench as they were called before (`formerly:`), by their present names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from pico.diagnostics import Diagnostic, SourceRange, warning
from pico.manifest.file_names import RENAMED
from pico.manifest.text.tree import Document, List, Map, Node, Scalar
from pico.model.address import Renaming, called_now, renamed_expression

_PROSE = ("apiVersion", "kind", "metadata", "figures", "notes", "parameters")
"""Keys of a recipe below which no part is named."""
_REVISIONS = ("apply", "checkout", "branch", "tag", "commit", "call", "prompt", "name", "as", "for", "message")
"""Keys of steps whose value is no part, but may be called as one."""
_LIST_OF_WORDS = re.compile(r"[\w./=+-]+(?:\s+[\w./=+-]+)*")


@dataclass
class Renamed:
    """A recipe by the present names of parts; `told`: a warning for each former name in it."""

    document: Document
    told: tuple[Diagnostic, ...] = ()


def by_present_names(document: Document, names: Renaming) -> Renamed | None:
    """Return a recipe by the present names of parts, None if it uses no former one. The document stays as it is."""
    root = document.root
    if not isinstance(root, Map) or not any(old in document.source.content for old in names):
        return None
    rewriting = _Rewriting(document, names)
    entries = {k: (key, node if k in _PROSE else rewriting.node(node, k)) for k, (key, node) in root.entries.items()}
    if not rewriting.first:
        return None
    made = replace(document, root=Map(root.start, root.flow, root.end, entries))
    return Renamed(made, tuple(rewriting.warnings()))


@dataclass
class _Rewriting:
    document: Document
    names: Renaming
    # Where each former name stands first.
    first: dict[str, SourceRange] = field(default_factory=dict)

    def node(self, node: Node, key: str) -> Node:
        """Return a copy of a node, which is the value of a key, by present names."""
        if isinstance(node, Scalar):
            return self._scalar(node, key)
        if isinstance(node, List):
            return List(node.start, node.flow, node.end, [self.node(item, key) for item in node.items])
        entries: dict[str, tuple[Scalar, Node]] = {}
        for name, (at, value) in node.entries.items():
            now = called_now(self.names, name)
            if now != name:
                self._used(name.partition(".")[0], at)
            entries[now] = (replace(at, text=now), self.node(value, name))
        return Map(node.start, node.flow, node.end, entries)

    def _scalar(self, node: Scalar, key: str) -> Scalar:
        text = renamed_expression(self.names, node.text)
        if key not in _REVISIONS and _LIST_OF_WORDS.fullmatch(text):
            text = " ".join(called_now(self.names, word) for word in text.split())
        if text == node.text:
            return node
        for old in self.names:
            if re.search(rf"\b{re.escape(old)}\b", node.text):
                self._used(old, node)
        return replace(node, text=text)

    def _used(self, old: str, node: Scalar) -> None:
        self.first.setdefault(old, self.document.source.range(node.start, node.end))

    def warnings(self) -> Iterator[Diagnostic]:
        for old, at in self.first.items():
            now = self.names[old]
            yield warning(RENAMED, f"{old} is now called {now}", hint=f"write `{now}` here", address=now, source=at)
