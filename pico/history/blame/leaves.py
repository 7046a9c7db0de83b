"""Leaves of a state as short texts, so that thousands of versions are compared at once."""

from __future__ import annotations

import contextlib
import json
import math
from typing import Any

from pico.manifest.text.tree import Map, Node, Scalar, plain
from pico.model.state import OFFSET, is_reference

Leaf = str
"""A value as JSON text: `90`, `true`, `"open"`, `"1.2 cm"`, `[520,420,30]` (a pose: mm, mm, deg), `"storage/a1"`."""

POSE = "pose"
_AXES = (("x", "mm"), ("y", "mm"), ("yaw", "deg"))


def leaf_of(value: Any) -> Leaf:
    """Return a value as a leaf; a number as a state's digest counts it (to 1e-6, whole ones without a point)."""
    if type(value) is float or type(value) is int:
        if not math.isfinite(value):
            return json.dumps(str(value))
        rounded = round(float(value), 6) + 0.0
        return str(int(rounded)) if rounded.is_integer() else repr(rounded)
    if isinstance(value, dict):
        return "{" + ",".join(f"{json.dumps(k)}:{leaf_of(v)}" for k, v in sorted(value.items())) + "}"
    return json.dumps("" if value is None else value, ensure_ascii=False)


def leaves_of(component: Node) -> dict[str, Leaf]:
    """Return the leaves of a component as a manifest gives them; its slot counts as its pose."""
    entries = component.entries if isinstance(component, Map) else {}
    leaves = {key: _leaf(value) for key, (_, value) in entries.items() if key not in ("slot", POSE)}
    place = place_of(component, "slot")
    return leaves | ({POSE: place} if place else {})


def place_of(node: Node, slot: str) -> Leaf:
    """Return where a component is, by its pose or else by the name under key `slot`; '' where neither is given."""
    pose = node.get(POSE) if isinstance(node, Map) else None
    if isinstance(pose, Map):
        numbers = [pose.get(axis) for axis, _ in _AXES]
        return pose_of(*(_leaf(n) if n else "0" for n in numbers))
    name = pose or (node.get(slot) if isinstance(node, Map) else None)
    return _leaf(name) if name else ""


def pose_of(x: Leaf, y: Leaf, yaw: Leaf) -> Leaf:
    """Return the leaf of a pose, given its numbers as leaves."""
    return f"[{x},{y},{yaw}]"


def canonical(tunable: str, leaf: Leaf | None, unit: str | None) -> Leaf | None:
    """Return a leaf with its texts that are quantities ("1.2 cm") in the declared unit; `unit` None: not known."""
    if leaf is None or '"' not in leaf:
        return leaf
    value = json.loads(leaf)
    if isinstance(value, list) and tunable == POSE:
        return pose_of(*(_in_unit(v, axis) for v, (_, axis) in zip(value, _AXES, strict=True)))
    return leaf if tunable == POSE or unit is None else _in_unit(value, unit)


def shown(leaf: Leaf | None) -> Any:
    """Return a leaf as changes show it: a slot's name, a pose as {x, y, yaw}, a value; None where there is none."""
    value = None if leaf is None else json.loads(leaf)
    if not isinstance(value, list) or len(value) != len(_AXES):
        return value
    return {axis: v for (axis, _), v in zip(_AXES, value, strict=True)}


def _leaf(node: Node) -> Leaf:
    return leaf_of(node.value if isinstance(node, Scalar) else plain(node))


def _in_unit(value: Any, unit: str) -> Leaf:
    from pico.model.quantities import QuantityError, convert

    if isinstance(value, str):
        with contextlib.suppress(QuantityError):
            value = convert(value, unit)
    if is_reference(value) and isinstance(value.get(OFFSET), str):
        with contextlib.suppress(QuantityError):
            value = {**value, OFFSET: convert(value[OFFSET], unit)}
    return leaf_of(value)
