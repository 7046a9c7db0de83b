"""`move: {p2: {x: 520, yaw: tilt}, lx_100: home}`: parts go to poses or slots, each alone and in a safe order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Map, Node, Scalar
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import NOTHING, Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope
from pico.recipes.terms import literal

KIND = Kind("parts go to poses, slots or home", "move: {p2: {x: 520, y: 420, yaw: +=30}, lx_100: home}", within=True)
_UNITS = {"x": "mm", "y": "mm", "yaw": "deg"}


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`move` takes parts with where they go", f"`{KIND.example}`")
        return Given({})
    values = {}
    for name, (at, node) in body.entries.items():
        if not reader.component(at, name):
            continue
        if not reader.setup.movable(name):
            reader.wrong(at, "capability", f"no arm can move {name}: only a person can")
        elif isinstance(node, Map):
            reader.keys(node, _UNITS, f"the pose of {name}")
            pairs = [(k, v) for k, (_, v) in node.entries.items() if k in _UNITS]
            values[name] = {
                k: reader.stepping(scope, v, f"{name}.pose.{k}", f"{k} of {name}", _UNITS[k]) for k, v in pairs
            }
        else:
            values[name] = _slot(reader, scope, name, node)
    return Given(values)


def _slot(reader: Reader, scope: Scope, name: str, node: Node) -> Any:
    home = reader.setup.lab.inventory[name].home
    if isinstance(node, Scalar) and node.text == "home" and home:
        return literal(home)
    term = reader.text(scope, node, f"where {name} goes")
    if term is not NOTHING and term.known and term.literal not in reader.setup.lab.slots:
        reader.slot(node, str(term.literal))
    return term


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be moved."""
    return doing.bench.plans.moving(given)


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.run(plan(doing, given))
    return {}
