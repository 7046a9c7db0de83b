"""`commit: first lens`: what stands on the bench is captured and committed, with the runs that led to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.history.messages.trailers import meta as noted
from pico.manifest.text.tree import Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.recipe import Name
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("what stands on the bench is captured and committed", "commit: first lens, tilt ${tilt}")
RECIPE = "recipe"


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    return Given({"message": reader.text(scope, body, "the message of a commit")}, names={"": Name("text")})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    bench = doing.bench
    history = bench.folder.history()
    head = history.head().commit
    meta = {RECIPE: f"{doing.recipe} {doing.step}"}
    if doing.head is not None and head not in (None, doing.head):  # it was made before the recipe was cut short
        made = history.resolve(str(head))
        if doing.head in made.parents and noted(made.message).get(RECIPE) == meta[RECIPE]:
            return {"": made.id}
    return {"": bench.commits.commit(str(given["message"]), "capture", meta=meta, empty=True).commit}
