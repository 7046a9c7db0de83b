"""What one manifest says, flat: each leaf as a short text, so that thousands of versions are compared at once."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pico.manifest.files import decode
from pico.manifest.kinds import kind_of
from pico.manifest.tree import Document, Map, Node, Scalar, parse, plain

Leaf = str
"""A value as JSON text: `90`, `true`, `"open"`, `"1.2 cm"`, `[520,420,30]` (a pose: mm, mm, deg), `"storage/a1"`."""

POSE = "pose"
_AXES = (("x", "mm"), ("y", "mm"), ("yaw", "deg"))


@dataclass(frozen=True, slots=True)
class Flat:
    """One manifest: `state`, by component the leaves that its LabStates give (a slot counts as the `pose`);
    `inventory`, by part its type and where it is when no state says; `units`, by type those of its tunables;
    `wrong`: why it can't be read."""

    state: Mapping[str, Mapping[str, Leaf]] = field(default_factory=dict)
    inventory: Mapping[str, tuple[str, Leaf]] = field(default_factory=dict)
    units: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    wrong: str = ""

    def dumps(self) -> str:
        """Return it as JSON, for `loads`."""
        return json.dumps([self.state, self.inventory, self.units, self.wrong], separators=(",", ":"))


def loads(text: str) -> Flat:
    """Return what `Flat.dumps` wrote; raises ValueError or TypeError for anything else."""
    state, inventory, units, wrong = json.loads(text)
    return Flat(state, {name: (kind, home) for name, (kind, home) in inventory.items()}, units, wrong)


def flatten(data: bytes) -> Flat:
    """Return what a manifest says, as far as it can be read; never raises. YAML that is not PICO's says nothing."""
    source, found = decode("", data)
    documents: list[Document] = []
    if source is not None:
        documents, found = parse(source)
    wrong = next((d.summary for d in found if d.severity == "error"), "")
    if source is None or wrong:
        return Flat(wrong=wrong)
    flat = Flat({}, {}, {})
    for document in documents:
        kind, found = kind_of(document)
        wrong = "" if kind else next((d.summary for d in found), "")
        if wrong:
            return Flat(wrong=wrong)
        if kind and isinstance(document.root, Map):
            _READ[kind](document.root, flat)
    return flat


def _state(root: Map, flat: Flat) -> None:
    assert isinstance(flat.state, dict)
    components = root.get("components")
    for name, (_, node) in components.entries.items() if isinstance(components, Map) else ():
        entries = node.entries if isinstance(node, Map) else {}
        leaves = {key: _leaf(value) for key, (_, value) in entries.items() if key not in ("slot", POSE)}
        place = _place(node, "slot")
        flat.state.setdefault(name, leaves | ({POSE: place} if place else {}))


def _lab(root: Map, flat: Flat) -> None:
    assert isinstance(flat.inventory, dict)
    inventory = root.get("inventory")
    for name, (_, part) in inventory.entries.items() if isinstance(inventory, Map) else ():
        kind = part.get("type") if isinstance(part, Map) else None
        flat.inventory[name] = (kind.text if isinstance(kind, Scalar) else "", _place(part, "home"))


def _type(root: Map, flat: Flat) -> None:
    assert isinstance(flat.units, dict)
    metadata, tunables = root.get("metadata"), root.get("tunables")
    name = metadata.get("name") if isinstance(metadata, Map) else None
    if isinstance(name, Scalar):
        declared = plain(tunables) if isinstance(tunables, Map) else {}
        flat.units[name.text] = {
            key: str(tunable.get("unit") or "") for key, tunable in declared.items() if isinstance(tunable, dict)
        }


_READ: Mapping[str, Callable[[Map, Flat], None]] = {"LabState": _state, "Lab": _lab, "ComponentType": _type}


def _place(node: Node, slot: str) -> Leaf:
    """Return where a component is, by its pose or else by the name under key `slot`; '' where neither is given."""
    pose = node.get(POSE) if isinstance(node, Map) else None
    if isinstance(pose, Map):
        numbers = [pose.get(axis) for axis, _ in _AXES]
        return "[" + ",".join(_leaf(n) if n else "0" for n in numbers) + "]"
    name = pose or (node.get(slot) if isinstance(node, Map) else None)
    return _leaf(name) if name else ""


def _leaf(node: Node) -> Leaf:
    value = node.value if isinstance(node, Scalar) else plain(node)
    if type(value) is float or type(value) is int:
        return _number(float(value))
    return json.dumps("" if value is None else value, ensure_ascii=False)


def _number(value: float) -> Leaf:
    """Return a number as a state's digest counts it: to 1e-6, whole numbers without a point."""
    if not math.isfinite(value):
        return json.dumps(str(value))
    rounded = round(value, 6) + 0.0
    return str(int(rounded)) if rounded.is_integer() else repr(rounded)


def canonical(tunable: str, leaf: Leaf | None, unit: str | None) -> Leaf | None:
    """Return a leaf with its texts that are quantities ("1.2 cm") in the declared unit; `unit` None: not known."""
    if leaf is None or '"' not in leaf:
        return leaf
    value = json.loads(leaf)
    if isinstance(value, list) and tunable == POSE:
        return "[" + ",".join(_in_unit(v, axis) for v, (_, axis) in zip(value, _AXES, strict=False)) + "]"
    return leaf if tunable == POSE or unit is None else _in_unit(value, unit)


def _in_unit(value: Any, unit: str) -> Leaf:
    from pico.model.quantities import QuantityError, convert

    if isinstance(value, str):
        try:
            value = convert(value, unit)
        except QuantityError:
            return json.dumps(value, ensure_ascii=False)
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return _number(float(value)) if number else json.dumps(value, ensure_ascii=False)


def shown(leaf: Leaf | None) -> Any:
    """Return a leaf as changes show it: a slot's name, a pose as {x, y, yaw}, a value; None where there is none."""
    value = None if leaf is None else json.loads(leaf)
    return dict(zip(("x", "y", "yaw"), value, strict=False)) if isinstance(value, list) and len(value) == 3 else value
