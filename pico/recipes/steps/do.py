"""`do: cam auto_range`: another primitive of a component, its arguments as `key=value`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import did_you_mean
from pico.manifest.text.tree import Node, Scalar
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("another primitive of a component", "do: cam auto_range", within=True)
ELSEWHERE = ("move", "stow", "set", "home", "measure", "scan")
"""Primitives that have steps of their own."""


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    words = body.text.split() if isinstance(body, Scalar) else []
    if len(words) < 2 or any("=" not in word for word in words[2:]):
        reader.wrong(body, "type", "`do` takes a component, a primitive and its arguments", f"`{KIND.example}`")
        return Given({})
    if reader.component(body, words[0]):
        able = [p for p in reader.setup.type_of(words[0]).primitives if p not in ELSEWHERE]
        if words[1] in ELSEWHERE:
            reader.wrong(body, "step", f"`{words[1]}` is a step of its own", f"`- {words[1]}: ...`")
        elif words[1] not in able:
            hint = did_you_mean(words[1][:40], able) or f"it can: {', '.join(able) or 'nothing else'}"
            reader.wrong(body, "capability", f"{words[0]} knows no `{words[1][:40]}`", hint)
    arguments = dict(word.split("=", 1) for word in words[2:])
    return Given({"component": words[0], "primitive": words[1], "arguments": arguments})


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be done."""
    return doing.bench.plans.single(given["component"], given["primitive"], given["arguments"])


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.run(plan(doing, given))
    return {}
