"""The JSON Schema of recipes, for editors: it knows every step of PICO, with what may stand beside it.

`python -m pico.recipes.schema` writes `schemas/recipe.json`; with `--check` it only says whether that is current. Those
of the other kinds: `pico.manifest.schema`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pico.manifest.schema import DRAFT
from pico.manifest.text.kinds import API, NAME
from pico.model.trace.unattended import ENDS
from pico.recipes import parameters, reading, unattended
from pico.recipes.reading_steps import BESIDE, OF
from pico.recipes.registry import CONTROL, own, step_file
from pico.resources import schemas_dir

LISTS = ("steps", "then", "else")
"""Keys beside a step that hold steps."""


def schema() -> dict[str, Any]:
    """Return the schema, draft-07. What an expression may speak of, and whether a state can be, no schema tells:
    `pico recipe check` does."""
    name = {"type": "string", "pattern": f"^{NAME.pattern}$"}
    steps = {"type": "array", "items": {"$ref": "#/definitions/step"}}
    about = {key: {"type": "string"} for key in reading.METADATA} | {"name": {"type": "string"}}
    fields: dict[str, Any] = {
        "apiVersion": {"const": API}, "kind": {"const": "Recipe"}, "metadata": _object(about, "name"),
        "parameters": {"type": "object", "propertyNames": name, "additionalProperties": {
            "anyOf": [{"type": ["number", "string", "boolean", "array", "null"]}, _object(
                _any(parameters.KEYS) | {"kind": {"enum": [*parameters.KINDS]}})]}},
        "steps": steps, "finally": steps, "returns": {"type": "object"},
        "unattended": _object(_any(unattended.KEYS) | {
            "laser_class": {"type": ["string", "number"]}, "hours": _object({"from": {}, "to": {}}, "from", "to"),
            "stop": {"type": "array"}, "end": {"type": "array", "items": {"enum": [*ENDS]}}}),
    }  # fmt: skip
    fields = _any(reading.KEYS) | fields
    found = {"$schema": DRAFT, "title": "A PICO recipe: an experiment as one file"}
    return found | _object(fields, "apiVersion", "kind", "metadata", "steps") | {"definitions": {"step": _step()}}


def _step() -> dict[str, Any]:
    """Return the schema of one step: one thing that is done, and what stands beside it; those of plug-ins it does not
    know."""
    beside = {kind: tuple(step_file(kind).KIND.keys) for kind in own()} | {k: (k, *v) for k, v in OF.items()}
    kinds = {kind: {"description": _said(kind)} for kind in beside}
    more = _any(key for keys in (*beside.values(), BESIDE) for key in keys if key not in kinds)
    lists = {key: {"type": "array", "items": {"$ref": "#/definitions/step"}} for key in LISTS}
    of_kind = [
        {"if": {"required": [kind]}, "then": {"propertyNames": {"enum": [kind, *keys, *BESIDE]}}}
        for kind, keys in ((kind, tuple(k for k in keys if k != kind)) for kind, keys in beside.items())
    ]
    return {"type": "object", "properties": kinds | more | lists, "minProperties": 1, "allOf": of_kind,
            "anyOf": [{"required": [kind]} for kind in kinds]}  # fmt: skip


def _said(kind: str) -> str:
    what, _, example = CONTROL.get(kind, "").partition(": ")
    if not what:
        what, example = step_file(kind).KIND.what, step_file(kind).KIND.example
    return f"{what}, such as `{example}`"


def _any(keys: Iterable[str]) -> dict[str, Any]:
    return {key: {} for key in keys}


def _object(properties: dict[str, Any], *required: str) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": [*required], "additionalProperties": False}


def text() -> str:
    """Return the schema as it stands in its file."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def path() -> Path:
    """Return where the schema is."""
    return schemas_dir() / "recipe.json"


if __name__ == "__main__":
    import sys

    if "--check" not in sys.argv[1:]:
        path().write_text(text(), encoding="utf-8", newline="\n")
    elif not path().is_file() or path().read_text(encoding="utf-8") != text():
        sys.exit("not current: recipe.json; run `python -m pico.recipes.schema`")
