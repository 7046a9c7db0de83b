"""JSON Schemas (draft-07, which editors understand) of manifests, plans, runs and the like, generated from the model.

`python -m pico.manifest.schema` writes `schemas/*.json`; with `--check` it only says whether they are current.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pico.manifest.checks.elements import own
from pico.manifest.text.kinds import API, KINDS, METADATA, NAME, PATH_NAME
from pico.resources import schemas_dir

DRAFT = "http://json-schema.org/draft-07/schema#"
_NAMED = {"inventory": NAME, "robots": NAME, "cameras": NAME, "datums": NAME, "keep_out": NAME, "tunables": NAME,
          "parameters": NAME, "measurables": NAME, "goals": NAME, "claims": NAME,
          "devices": NAME, "safety_inputs": NAME, "slots": PATH_NAME, "regions": PATH_NAME}  # fmt: skip
_QUANTITY = [{"type": "number"}, {"type": "string", "pattern": r"^\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*\S+"}]


def schemas() -> dict[str, dict[str, Any]]:
    """Return the schemas by file name without its ending: one a kind, `manifest` for all, `plan`, `event`, `run`,
    `measurement`."""
    from pico.model.catalog import ComponentType
    from pico.model.lab import Lab
    from pico.model.measurement import Measurement
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.model.trace.run import Run
    from pico.model.wiring import Wiring

    kinds = {
        "Lab": _manifest("Lab", Lab),
        "LabState": _lab_state(),
        "ComponentType": _manifest("ComponentType", ComponentType),
        "Devices": _manifest("Devices", Wiring),
    }
    return {
        "lab": _titled("A PICO lab: the bench and its inventory", kinds["Lab"]),
        "lab_state": _titled("A PICO laboratory state", kinds["LabState"]),
        "component_type": _titled("A PICO component type", kinds["ComponentType"]),
        "devices": _titled("The instruments of a PICO lab", kinds["Devices"]),
        "manifest": _combined(kinds),
        "plan": _titled("A PICO plan, pico.plan/v1", _of(Plan)),
        "event": _titled("An event of an execution, pico.event/v1", _of(Event)),
        "run": _titled("A run as a commit carries it, pico.run/v1", _of(Run)),
        "measurement": _titled("What was measured, pico.measurement/v1", _of(Measurement)),
    }


def _of(record: type) -> dict[str, Any]:
    from pydantic import TypeAdapter

    schema = TypeAdapter(record).json_schema(ref_template="#/definitions/{model}")
    result: dict[str, Any] = _draft_07(schema)
    if "OpticalElement" in result.get("definitions", {}):
        result["definitions"]["OpticalElement"]["properties"]["element"]["enum"] = list(own())
    return result


def _draft_07(node: Any) -> Any:
    """Return a schema of draft 2020-12, as pydantic writes it, in the words of draft-07, without made-up titles."""
    if isinstance(node, list):
        return [_draft_07(item) for item in node]
    if not isinstance(node, dict):
        return node
    result: dict[str, Any] = {}
    for key, value in node.items():
        if key == "$defs":
            result["definitions"] = {name: _draft_07(inner) for name, inner in value.items()}
        elif key == "properties":
            result[key] = {name: _draft_07(inner) for name, inner in value.items()}
        elif key == "prefixItems":
            result |= {"items": _draft_07(value), "additionalItems": False}
        elif key == "description":
            result[key] = " ".join(value.split())
        elif not (key == "title" and isinstance(value, str)):
            result[key] = value if key in ("default", "enum", "const", "required") else _draft_07(value)
    return result


def _manifest(kind: str, record: type) -> dict[str, Any]:
    """Return the schema of a manifest whose record's `METADATA` fields stand in `metadata`."""
    schema = _of(record)
    fields, wanted = dict(schema["properties"]), list(schema["required"])
    metadata = {name: fields.pop(name) for name in METADATA[kind]}
    named = METADATA[kind][0]
    metadata[named] = metadata[named] | {"pattern": f"^{NAME.pattern}$"}
    for name, rule in _NAMED.items():
        if name in fields:
            fields[name] = fields[name] | {"propertyNames": {"pattern": f"^{rule.pattern}$"}}
    header = _header(kind, metadata, [name for name in wanted if name in metadata])
    return schema | {
        "properties": header | fields,
        "required": [*header, *(name for name in wanted if name not in metadata)],
    }


def _header(kind: str, metadata: dict[str, Any], wanted: list[str]) -> dict[str, Any]:
    inner = {"type": "object", "properties": metadata, "required": wanted, "additionalProperties": False}
    return {"apiVersion": {"const": API}, "kind": {"const": kind}, "metadata": inner}


def _lab_state() -> dict[str, Any]:
    def quantity(text: str) -> dict[str, Any]:
        return {"anyOf": _QUANTITY, "description": text}

    pose = {
        "type": "object",
        "description": "Where the component stands on the table: origin at the front-left corner.",
        "properties": {
            "x": quantity("to the right, in mm"),
            "y": quantity("away from the front edge, in mm"),
            "yaw": quantity("counter-clockwise seen from above, in deg"),
        },
        "required": ["x", "y"],
        "additionalProperties": False,
    }
    component = {
        "type": ["object", "null"],
        "description": "Exactly one of `slot` and `pose`, and one key a tunable, in the unit that the type declares.",
        "properties": {"slot": {"type": "string", "description": "a storage place of the lab"}, "pose": pose},
        "additionalProperties": {"type": ["number", "boolean", "string"]},
        "not": {"required": ["slot", "pose"]},
    }
    expectation = {
        "type": "object",
        "properties": {
            "that": {"type": "string", "description": "an expression that must hold after an apply"},
            "message": {"type": "string", "description": "what to say where it does not"},
        },
        "required": ["that"],
        "additionalProperties": False,
    }
    header = _header("LabState", {"lab": {"type": "string", "pattern": f"^{NAME.pattern}$"}}, ["lab"])
    components = {
        "type": ["object", "null"],
        "propertyNames": {"pattern": f"^{NAME.pattern}$"},
        "additionalProperties": component,
    }
    return {
        "type": "object",
        "description": "Components of the inventory with their tunables: what a commit holds.",
        "properties": header | {"components": components, "expect": {"type": ["array", "null"], "items": expectation}},
        "required": list(header),
        "additionalProperties": False,
    }


def _combined(kinds: dict[str, dict[str, Any]]) -> dict[str, Any]:
    definitions: dict[str, Any] = {}
    branches = []
    for kind, schema in kinds.items():
        definitions |= schema.get("definitions", {})
        definitions[f"{kind}Manifest"] = {k: v for k, v in schema.items() if k != "definitions"}
        chosen = {"properties": {"kind": {"const": kind}}, "required": ["kind"]}
        branches.append({"if": chosen, "then": {"$ref": f"#/definitions/{kind}Manifest"}})
    body = {
        "type": "object",
        "properties": {"apiVersion": {"const": API}, "kind": {"enum": list(KINDS)}},
        "required": ["apiVersion", "kind", "metadata"],
        "allOf": branches,
        "definitions": definitions,
    }
    return _titled("A PICO manifest", body)


def _titled(title: str, body: dict[str, Any]) -> dict[str, Any]:
    return {"$schema": DRAFT, "title": title} | body


def write(folder: Path) -> None:
    """Write every schema into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in _texts().items():
        (folder / name).write_text(text, encoding="utf-8", newline="\n")


def outdated(folder: Path) -> list[str]:
    """Return the names of the schema files in `folder` that are missing or not what the model says now."""
    texts = _texts()
    return [n for n, t in texts.items() if not (folder / n).is_file() or (folder / n).read_text(encoding="utf-8") != t]


def _texts() -> dict[str, str]:
    return {
        f"{name}.json": json.dumps(schema, indent=2, ensure_ascii=False) + "\n" for name, schema in schemas().items()
    }


if __name__ == "__main__":
    import sys

    if "--check" in sys.argv[1:]:
        old = outdated(schemas_dir())
        sys.exit(f"not current: {', '.join(old)}; run `python -m pico.manifest.schema`" if old else 0)
    write(schemas_dir())
