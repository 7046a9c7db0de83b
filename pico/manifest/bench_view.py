"""What a laboratory state is read against: the parts, slots and types of a bench, even where its lab has errors."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from pico.manifest.text.kinds import NAME
from pico.manifest.text.tree import Document, Map, Scalar
from pico.model.address import Renaming, renaming_of
from pico.model.catalog import Catalog, ComponentType
from pico.model.setup import Setup


@dataclass(frozen=True)
class BenchView:
    """The names that a state may use. `kinds` holds None for a part whose type is not known; `formerly`: the present
    names of parts by their former ones; `without`: components that are left out if the bench has no such part."""

    lab: str | None = None
    kinds: Mapping[str, ComponentType | None] = field(default_factory=dict)
    fixed: Collection[str] = frozenset()
    homes: Mapping[str, str] = field(default_factory=dict)
    slots: Collection[str] = frozenset()
    size: tuple[float, float] | None = None
    formerly: Renaming = field(default_factory=dict)
    without: Collection[str] = ()

    def name(self, word: str) -> str:
        """Return the present name of the part that a word names."""
        return self.formerly.get(word, word)


def view_of(setup: Setup) -> BenchView:
    """Return what a state may name on a bench."""
    parts = setup.lab.inventory
    return BenchView(
        lab=setup.lab.name,
        kinds={name: setup.catalog.get(part.type) for name, part in parts.items()},
        fixed=frozenset(name for name, part in parts.items() if part.pose),
        homes={name: part.home for name, part in parts.items() if part.home},
        slots=setup.lab.slots.keys(),
        size=setup.lab.table.size,
        formerly=renaming_of(setup.lab),
    )


def view_of_broken(document: Document, catalog: Catalog) -> BenchView | None:
    """Return what can be told of a bench whose Lab document has errors, so that its states are checked all the same.

    None where not even its inventory can be read.
    """
    root = document.root
    if not isinstance(root, Map) or not isinstance(root.get("inventory"), Map):
        return None
    metadata, inventory = _map(root, "metadata"), _map(root, "inventory")
    kinds: dict[str, ComponentType | None] = {}
    fixed, homes = set(), {}
    for name, (_, part) in inventory.entries.items():
        kinds[name] = catalog.get(_text(part, "type") or "")
        home = _text(part, "home")
        if home is None:
            fixed.add(name)
        else:
            homes[name] = home
    slots = _map(root, "slots").entries.keys()
    lab = _text(metadata, "name")
    return BenchView(lab if lab and NAME.fullmatch(lab) else None, kinds, fixed, homes, slots)


def type_names(document: Document) -> set[str]:
    """Return the types that the inventory of a Lab document names, whatever else is wrong with it."""
    parts = _map(document.root, "inventory").entries.values()
    return {name for _, part in parts if (name := _text(part, "type"))}


def has_part(document: Document, name: str) -> bool:
    """Return whether the inventory of a Lab document names a part, whatever else is wrong with it."""
    return name in _map(document.root, "inventory").entries


def _map(node: object, key: str) -> Map:
    value = node.get(key) if isinstance(node, Map) else None
    return value if isinstance(value, Map) else Map(0, False)


def _text(node: object, key: str) -> str | None:
    value = node.get(key) if isinstance(node, Map) else None
    return value.text if isinstance(value, Scalar) and isinstance(value.value, str) else None
