"""Where in a document something stands, by its path of keys."""

from __future__ import annotations

from pico.diagnostics import SourceRange
from pico.manifest.text.tree import Document, List, Map, Node, last_leaf


def find(document: Document, *path: str | int) -> tuple[Node, Node] | None:
    """Return the key's node and the value's node at `path`; the two are the same for an item of a list."""
    key: Node = document.root
    node: Node = document.root
    for step in path:
        if isinstance(node, Map) and isinstance(step, str) and step in node.entries:
            key, node = node.entries[step]
        elif isinstance(node, List) and isinstance(step, int) and step < len(node.items):
            key = node = node.items[step]
        else:
            return None
    return key, node


def where(document: Document, *path: str | int) -> SourceRange:
    """Return the place of the value at `path`: the key where the value is a block or empty, the nearest that exists."""
    steps = list(path)
    found = find(document, *steps)
    while found is None:
        steps.pop()
        found = find(document, *steps)
    key, node = found
    if node is document.root and isinstance(node, Map) and node.entries:
        key = node = next(iter(node.entries.values()))[0]
    shown = key if (isinstance(node, Map | List) and not node.flow) or node.start == node.end else node
    return document.source.range(shown.start, last_leaf(shown).end)


def where_key(document: Document, *path: str | int) -> SourceRange:
    """Return the place of the key at `path`, or of the nearest one above that exists."""
    found = find(document, *path)
    if found is None or not path:
        return where(document, *path)
    return document.source.range(found[0].start, found[0].end)
