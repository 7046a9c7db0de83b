"""`checkout: C3`: files and bench go to a revision."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Node
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("files and bench go to a revision", "checkout: C3")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"revision": reader.revision(scope, body)})


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be moved."""
    return doing.bench.plans.plan(given["revision"])


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    bench = doing.bench
    moves = bench.plans.checkout_plan(given["revision"])
    bench.history.checkout(given["revision"])
    doing.run(moves)
    return {"": bench.history.head_name()}
