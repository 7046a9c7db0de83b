"""Documents of older versions are lifted a step at a time; those of newer ones are refused by name."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.base.formats import Document, Format
from pico.diagnostics import PicoError
from pico.model.plan import FORMAT, Base, LabRef, Plan, Target, plan_from_json


def steps(count: int) -> tuple:  # type: ignore[type-arg]
    def step(number: int, document: Document) -> Document:
        return {**document, "steps": [*document.get("steps", []), number]}

    return tuple(lambda document, number=number: step(number, document) for number in range(1, count + 1))


@given(st.integers(0, 5), st.data())
def test_a_document_takes_the_steps_from_its_version_to_the_current_one(newest: int, data: st.DataObject) -> None:
    version = data.draw(st.integers(1, newest + 1))
    found = Format("pico.thing", steps(newest)).lifted({"schema": f"pico.thing/v{version}", "kept": 1})
    assert found.pop("steps", []) == list(range(version, newest + 1))
    assert found == {"schema": f"pico.thing/v{newest + 1}", "kept": 1}


@pytest.mark.parametrize(
    ("document", "said"),
    [
        ({"schema": "pico.thing/v3"}, r"of a newer PICO \(pico.thing/v3; this one reads up to pico.thing/v2\)"),
        ({"schema": "pico.other/v1"}, "no pico.thing/v2, but 'pico.other/v1'"),
        ({"schema": "pico.thing/v0"}, "no pico.thing/v2"),
        ({"schema": 1}, "no pico.thing/v2"),
        ({}, "no pico.thing/v2, but 'None'"),
        ([], "no pico.thing/v2"),
    ],
)
def test_another_format_and_a_newer_version_are_refused(document: object, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Format("pico.thing", steps(1)).lifted(document)


def plan() -> Plan:
    lab = LabRef(name="shel", digest="sha256:0")
    return Plan(lab=lab, backend="sim", fidelity="kinematic", base=Base(), target=Target()).sealed()


def test_a_plan_written_before_a_field_existed_keeps_its_digest() -> None:
    from pico.model.plan import _digest

    written = json.loads(plan().to_json())
    del written["policy"]
    written["digest"] = _digest(written)
    assert plan_from_json(json.dumps(written)).digest == written["digest"] != plan().digest


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "the saved plan cannot be read"),
        ("[]", f"no {FORMAT.schema}"),
        (plan().to_json().replace("pico.plan/v1", "pico.plan/v9"), "of a newer PICO"),
        (plan().to_json().replace("kinematic", "physics"), "changed after it was saved"),
    ],
)
def test_what_is_no_plan_of_this_version_is_refused(text: str, said: str) -> None:
    with pytest.raises(PicoError, match=said):
        plan_from_json(text)
