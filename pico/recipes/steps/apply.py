"""`apply: e1`: the bench becomes as a revision says, or as the manifest; the files stay where they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Node, Scalar
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("the bench becomes as a revision says, or the manifest", "apply: e1")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    if isinstance(body, Scalar) and body.value is None:
        return Given({"revision": None})
    return Given({"revision": reader.revision(scope, body)})


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be moved."""
    return doing.bench.plans.plan(given["revision"])


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.run(plan(doing, given))
    return {}
