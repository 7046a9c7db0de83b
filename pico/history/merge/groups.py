"""Which tunables of a lab belong together, read straight from its files: a merge driver must not wait for more."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from pico.history.merge.leaves import Groups
from pico.manifest.files import decode_all, read_folder
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, parse, plain
from pico.resources import catalog_dir

_IS_LAB = re.compile(rb"^kind:[ \t]*[\"']?Lab[\"']?[ \t]*(?:#.*)?\r?$", re.MULTILINE)


def groups_near(path: Path) -> tuple[Groups, bool]:
    """Return the groups of the lab around a file, by component, and whether changes in part of one conflict.

    What can't be read counts as not there: the file may be in conflict itself.
    """
    root = lab_around(path)
    return groups_of(read_folder(root)[0].items()) if root else ({}, False)


def lab_around(path: Path) -> Path | None:
    """Return the nearest folder above a file that holds a lab, None where there is none."""
    return next((folder for folder in path.absolute().parents if _holds_lab(folder)), None)


def _holds_lab(folder: Path) -> bool:
    try:
        return any(is_lab(path.read_bytes()) for path in sorted(folder.glob("*.yaml")) if path.is_file())
    except OSError:
        return False


def is_lab(data: bytes) -> bool:
    """Return whether a file holds a Lab."""
    return bool(_IS_LAB.search(data))


def groups_of(files: Iterable[tuple[str, bytes]]) -> tuple[Groups, bool]:
    """Return the same from the files of a lab, (path, content) each."""
    documents = _documents({path: data for path, data in files if b"ComponentType" in data or b"inventory" in data})
    types = {_text(d, "metadata", "name"): _coupled(d) for d in documents if _text(d, "kind") == "ComponentType"}
    found: dict[str, tuple[tuple[str, ...], ...]] = {}
    strict = False
    for lab in (d for d in documents if _text(d, "kind") == "Lab"):
        strict = strict or _text(lab, "policy", "merge") == "strict"
        inventory = _at(lab.root, "inventory")
        for name in inventory.entries if isinstance(inventory, Map) else ():
            kind = _text(lab, "inventory", name, "type")
            if kind not in types:
                types[kind] = _packaged(kind)
            if types[kind]:
                found[name] = types[kind]
    return found, strict


def _documents(files: dict[str, bytes]) -> list[Document]:
    return [document for source in decode_all(files)[0] for document in parse(source)[0]]


def _packaged(kind: str) -> tuple[tuple[str, ...], ...]:
    path = catalog_dir() / f"{kind}.yaml"
    if not kind.isidentifier() or not path.is_file():
        return ()
    data = path.read_bytes()
    return next((_coupled(d) for d in _documents({path.name: data})), ()) if b"\ncoupled:" in data else ()


def _coupled(document: Document) -> tuple[tuple[str, ...], ...]:
    node = _at(document.root, "coupled")
    groups = plain(node) if isinstance(node, List) else []
    return tuple(tuple(str(name) for name in group) for group in groups if isinstance(group, list))


def _at(node: Node | None, *keys: str) -> Node | None:
    for key in keys:
        node = node.get(key) if isinstance(node, Map) else None
    return node


def _text(document: Document, *keys: str) -> str:
    node = _at(document.root, *keys)
    return node.text if isinstance(node, Scalar) else ""
