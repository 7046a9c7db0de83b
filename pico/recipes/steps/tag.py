"""`tag: E1-1`: the commit that is checked out gets a name for good."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError
from pico.manifest.text.tree import Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("the commit that is checked out gets a name for good", "tag: E1-1")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"name": reader.new_revision(scope, body, "a tag")})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    history, name = doing.bench.folder.history(), str(given["name"])
    try:
        history.tag(name)
    except PicoError:
        if not doing.again or history.resolve(f"refs/tags/{name}").id != history.head().commit:
            raise
    return {}
