"""What a diff of one manifest wants to know of the lab around it, read straight from its files, and only if asked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path

from pico.history.merge.groups import lab_around
from pico.manifest.files import decode, read_folder
from pico.manifest.text.tree import Document, Map, Node, Scalar, parse
from pico.resources import catalog_dir

_KINDS = (b"inventory", b"ComponentType")


class Surroundings:
    """The lab around a file. What can't be read counts as not there: the file itself may be in conflict."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def unit(self, component: str, tunable: str) -> str:
        """Return the unit of a tunable; empty where it has none, or nobody knows."""
        kind = text(self.lab, "inventory", component, "type")
        if kind not in self._units:
            self._units[kind] = _units(self.types.get(kind) or _packaged(kind))
        return self._units[kind].get(tunable, "")

    def home(self, component: str) -> str:
        """Return the home slot of a component; empty where it has none, or nobody knows."""
        return text(self.lab, "inventory", component, "home")

    @cached_property
    def lab(self) -> Node | None:
        """The manifest of kind Lab."""
        return next((d.root for d in self._documents if text(d.root, "kind") == "Lab"), None)

    @cached_property
    def types(self) -> Mapping[str, Node]:
        """The lab's own component types by name."""
        return {text(d.root, "metadata", "name"): d.root for d in self._documents if _is_type(d)}

    @cached_property
    def _units(self) -> dict[str, Mapping[str, str]]:
        return {}

    @cached_property
    def _documents(self) -> list[Document]:
        root = lab_around(self.path)
        files = read_folder(root)[0] if root else {}
        return [d for path, data in files.items() if any(k in data for k in _KINDS) for d in _parsed(path, data)]


def at(node: Node | None, *keys: str) -> Node | None:
    """Return what stands below a node, None where nothing does."""
    for key in keys:
        node = node.get(key) if isinstance(node, Map) else None
    return node


def text(node: Node | None, *keys: str) -> str:
    """Return the text of a scalar below a node; empty where there is none."""
    found = at(node, *keys)
    return found.text if isinstance(found, Scalar) else ""


def _parsed(path: str, data: bytes) -> Iterator[Document]:
    source, _ = decode(path, data)
    yield from parse(source)[0] if source else ()


def _is_type(document: Document) -> bool:
    return text(document.root, "kind") == "ComponentType"


def _packaged(kind: str) -> Node | None:
    path = catalog_dir() / f"{kind}.yaml"
    if not kind.isidentifier() or not path.is_file():
        return None
    return next((d.root for d in _parsed(path.name, path.read_bytes())), None)


def _units(kind: Node | None) -> dict[str, str]:
    tunables = at(kind, "tunables")
    return {name: text(tunables, name, "unit") for name in tunables.entries} if isinstance(tunables, Map) else {}


def components_in(data: bytes) -> frozenset[str]:
    """Return the components that a manifest holds; none where it can't be read."""
    found: set[str] = set()
    for document in _parsed("manifest", data):
        components = at(document.root, "components") if text(document.root, "kind") == "LabState" else None
        found |= components.entries.keys() if isinstance(components, Map) else set()
    return frozenset(found)
