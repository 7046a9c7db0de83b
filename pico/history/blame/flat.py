"""What one manifest says, flat: the leaves of its states, its inventory, the units of its component types."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from pico.history.blame.leaves import Leaf, leaves_of, place_of
from pico.history.blame.lines import read_lines
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.tree import Document, List, Map, Scalar, parse, plain


@dataclass(frozen=True, slots=True)
class Flat:
    """One manifest: `state`, by component the leaves that its LabStates give (a slot counts as the `pose`);
    `inventory`, by part its type and where it is when no state says; `units`, by type those of its tunables;
    `formerly`, by part the names that it had before; `wrong`: why it can't be read."""

    state: Mapping[str, Mapping[str, Leaf]] = field(default_factory=dict)
    inventory: Mapping[str, tuple[str, Leaf]] = field(default_factory=dict)
    units: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    wrong: str = ""
    formerly: Mapping[str, Sequence[str]] = field(default_factory=dict)

    def dumps(self) -> str:
        """Return it as JSON, for `loads`."""
        return json.dumps([self.state, self.inventory, self.units, self.wrong, self.formerly], separators=(",", ":"))


def loads(text: str) -> Flat:
    """Return what `Flat.dumps` wrote; raises ValueError, TypeError or AttributeError for anything else."""
    state, inventory, units, wrong, formerly = json.loads(text)
    return Flat(state, {name: (kind, home) for name, (kind, home) in inventory.items()}, units, wrong, formerly)


def flatten(data: bytes) -> Flat:
    """Return what a manifest says, as far as it can be read; never raises. YAML that is not PICO's says nothing."""
    state = read_lines(data)
    return parsed(data) if state is None else Flat(state)


def parsed(data: bytes) -> Flat:
    """Return the same by the parser alone, within its limits."""
    source, found = decode("", data)
    documents: list[Document] = []
    if source is not None:
        documents, found = parse(source)
    wrong = next((d.summary for d in found if d.severity == "error"), "")
    if source is None or wrong:
        return Flat(wrong=wrong)
    flat = Flat({}, {}, {}, formerly={})
    for document in documents:
        kind, found = kind_of(document)
        wrong = "" if kind else next((d.summary for d in found), "")
        if wrong:
            return Flat(wrong=wrong)
        if kind and isinstance(document.root, Map):
            _READ.get(kind, _nothing)(document.root, flat)
    return flat


def _state(root: Map, flat: Flat) -> None:
    assert isinstance(flat.state, dict)
    components = root.get("components")
    for name, (_, node) in components.entries.items() if isinstance(components, Map) else ():
        flat.state.setdefault(name, leaves_of(node))


def _lab(root: Map, flat: Flat) -> None:
    assert isinstance(flat.inventory, dict) and isinstance(flat.formerly, dict)
    inventory = root.get("inventory")
    for name, (_, part) in inventory.entries.items() if isinstance(inventory, Map) else ():
        kind = part.get("type") if isinstance(part, Map) else None
        flat.inventory[name] = (kind.text if isinstance(kind, Scalar) else "", place_of(part, "home"))
        former = part.get("formerly") if isinstance(part, Map) else None
        if isinstance(former, List):
            flat.formerly[name] = [item.text for item in former.items if isinstance(item, Scalar)]


def _type(root: Map, flat: Flat) -> None:
    assert isinstance(flat.units, dict)
    metadata, tunables = root.get("metadata"), root.get("tunables")
    name = metadata.get("name") if isinstance(metadata, Map) else None
    if isinstance(name, Scalar):
        declared = plain(tunables) if isinstance(tunables, Map) else {}
        flat.units[name.text] = {
            key: str(tunable.get("unit") or "") for key, tunable in declared.items() if isinstance(tunable, dict)
        }


def _nothing(root: Map, flat: Flat) -> None:
    """Devices are no part of a state."""


_READ: Mapping[str, Callable[[Map, Flat], None]] = {"LabState": _state, "Lab": _lab, "ComponentType": _type}
