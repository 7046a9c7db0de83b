"""`set: {p1.angle: 90 + tilt, p2.angle: +=5}`: tunables get values, or steps from where they are; several move side by
side, as far as their motors can."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Map, Node
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("tunables get values", "set: {p1.angle: 3, p2.angle: +=5, cam.exposure: 2 ms}", within=True)


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`set` takes tunables with their values", f"`{KIND.example}`")
        return Given({})
    values = {}
    for address, (at, node) in body.entries.items():
        if (known := reader.tunable_at(at, address)) is not None:
            values[address] = reader.tunable(scope, *known, node)
    return Given(values)


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be set."""
    return doing.bench.plans.setting(given)


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.run(plan(doing, given))
    return {}
