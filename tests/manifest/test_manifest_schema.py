"""The JSON Schemas are current, valid draft-07, and agree with the loader."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest
from manifest_samples import LAB, OWN_TYPE, STATE

from pico.manifest.schema import outdated, schemas
from pico.manifest.text.source import Source
from pico.manifest.text.tree import parse, plain
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.trace.event import Event
from pico.resources import catalog_dir, labs_dir, schemas_dir

SCHEMAS = schemas()


def data(text: str) -> Any:
    return plain(parse(Source("x", text))[0][0].root)


def test_the_schemas_of_the_repository_are_current() -> None:
    assert outdated(schemas_dir()) == []


@pytest.mark.parametrize("name", list(SCHEMAS))
def test_each_is_a_draft_07_schema(name: str) -> None:
    jsonschema.Draft7Validator.check_schema(SCHEMAS[name])
    text = json.dumps(SCHEMAS[name])
    assert "$defs" not in text
    assert "prefixItems" not in text


def valid(name: str, instance: Any) -> bool:
    return bool(jsonschema.Draft7Validator(SCHEMAS[name]).is_valid(instance))


@pytest.mark.parametrize(("name", "text"), [("lab", LAB), ("lab_state", STATE), ("component_type", OWN_TYPE)])
def test_manifests_are_valid_in_their_own_schema_and_the_common_one(name: str, text: str) -> None:
    assert valid(name, data(text))
    assert valid("manifest", data(text))


def test_everything_we_ship_is_valid() -> None:
    for path in [*catalog_dir().glob("*.yaml"), *labs_dir().rglob("*.yaml")]:
        text = path.read_text(encoding="utf-8")
        if "apiVersion:" in text and "recipes" not in path.parts:  # these are checked by the reader of recipes
            assert valid("manifest", data(text)), path


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (LAB, "beam_height: 70", "beam_hight: 70"), (LAB, "size: [1200, 900]", "size: [1200]"), (LAB, "p1:", "P1:"),
        (LAB, "type: hene_laser, ", ""), (LAB, "model: xarm7", "model: xarm9"), (STATE, "angle: 90.0", "angle: [90]"),
        (STATE, "slot: storage/a2", "slot: storage/a2\n    pose: {x: 1, y: 2}"), (STATE, "expect:", "expects:"),
        (OWN_TYPE, "element: lens", "element: lenz"), (OWN_TYPE, "kind: ComponentType", "kind: Component"),
    ],
)  # fmt: skip
def test_an_editor_sees_the_common_mistakes(text: str, old: str, new: str) -> None:
    assert not valid("manifest", data(text.replace(old, new, 1)))


def test_plans_and_events_are_valid_as_they_are_written() -> None:
    lab = LabRef(name="bench", digest="sha256:0")
    plan = Plan(lab=lab, backend="sim", fidelity="kinematic", base=Base(), target=Target()).sealed()
    assert valid("plan", json.loads(plan.to_json()))
    from pico.model.record import as_json

    assert valid("event", as_json(Event(run="r", seq=1, kind="run_started", time=0.0)))
