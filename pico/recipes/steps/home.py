"""`home: p1.angle`: an axis finds its zero."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Node, Scalar
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("an axis finds its zero", "home: p1.angle", within=True)


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    known = reader.tunable_at(body, body.text) if isinstance(body, Scalar) else None
    if known is None or known[2].axis is None or known[2].axis.kind != "homed":
        if known is not None or not isinstance(body, Scalar):
            reader.wrong(body, "capability", "`home` takes a tunable whose axis can be homed", f"`{KIND.example}`")
        return Given({})
    return Given({"component": known[0], "tunable": known[1]})


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be done."""
    return doing.bench.plans.single(given["component"], "home", {"tunable": given["tunable"]})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.run(plan(doing, given))
    return {}
