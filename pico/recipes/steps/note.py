"""`note: {p2: scratched at the rim}`: something is noted on parts, for the next commit to take along."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.manifest.text.tree import Map, Node
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("something is noted on parts", "note: {p2: scratched at the rim}", within=True)


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`note` takes parts with what there is to say", f"`{KIND.example}`")
        return Given({})
    known = [(name, node) for name, (at, node) in body.entries.items() if reader.component(at, name)]
    return Given({name: reader.text(scope, node, f"the note on {name}") for name, node in known})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    for part, text in given.items():
        if not (doing.again and any(str(n.text) == text for n in doing.bench.history.notes(part)[-1:])):
            doing.bench.history.note(part, str(text))
    return {}
