"""`capture:`: what the bench shows is written into the manifest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("what the bench shows is written into the manifest", "capture:")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"only": reader.addresses(body)})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    doing.bench.capture(*given["only"])
    return {}
