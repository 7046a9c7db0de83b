"""Which commit a value of a manifest comes from: to be named where a later change stands in the way."""

from __future__ import annotations

from typing import Any

from pico.history.merge.leaves import Path, canonical
from pico.manifest.files import decode
from pico.manifest.text.tree import Document, Map, Node, parse


def last_change(handle: Any, head: str, path: str, leaf: Path) -> str:
    """Return the commit, `head` or before it, that gave a manifest the value of `leaf` that it has at `head`.

    `path`: of the file in the repository; `leaf` begins with the number of the document. A file under another name
    before counts as new.
    """
    known: dict[str, list[Document]] = {}
    commit = handle[head]
    while True:
        value = value_at(handle, commit.tree, path, leaf, known)
        same = [p for p in commit.parents if value_at(handle, p.tree, path, leaf, known) == value]
        if not same:
            return str(commit.id)
        commit = same[0]


def value_at(handle: Any, tree: Any, path: str, leaf: Path, known: dict[str, list[Document]] | None = None) -> Any:
    """Return a value of a manifest in a tree, to be compared; None where it is not there. `known`: read already."""
    known = {} if known is None else known
    try:
        blob = str(tree[path].id)
    except KeyError:
        return None
    if blob not in known:
        source = decode(path, handle[blob].data)[0]
        known[blob] = parse(source)[0] if source else []
    number, *keys = leaf
    documents = known[blob]
    node: Node | None = documents[int(number)].root if int(number) < len(documents) else None
    for key in keys:
        node = node.get(key) if isinstance(node, Map) else None
    return canonical(node) if node else None
