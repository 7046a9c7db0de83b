"""`branch: e1`: a branch begins at the commit that is checked out; commits go to it from then on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError
from pico.manifest.text.tree import Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("a branch begins here, and is checked out", "branch: e1")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"name": reader.new_revision(scope, body, "a branch")})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    history = doing.bench.folder.history()
    branch = f"refs/heads/{given['name']}"  # a tag may have the same name
    if history.head().branch != given["name"]:
        try:
            history.branch(str(given["name"]))
        except PicoError:  # made before the recipe was cut short, and not yet checked out
            if not doing.again or history.resolve(branch).id != history.head().commit:
                raise
        doing.bench.history.checkout(branch)
    return {}
