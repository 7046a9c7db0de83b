"""`wait: 5 s`: nothing is done for a while, on the bench's clock."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("nothing is done for a while", "wait: 5 s")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"seconds": reader.number(scope, body, "the time to wait", "s", 0.0, 86_400.0)})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.pause(float(given["seconds"]))
    return {}
