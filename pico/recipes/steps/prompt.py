"""`prompt: Put the sample in.`: a person does something and says so, or tells a value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.manifest.text.tree import Map, Node, Scalar
from pico.model.trace.question import Question
from pico.recipes.doing import Doing
from pico.recipes.parameters import read_parameter
from pico.recipes.reader import Reader
from pico.recipes.recipe import Name, Parameter
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

_VALUE = ("kind", "unit", "range", "choices", "default")
KIND = Kind(
    "a person does something and says so, or tells a value",
    "prompt: Put the sample in.",
    keys={
        "unattended": "what is done where nobody is there: `fail`, or `skip`, with which a value is its default",
        "kind": "of the value that is asked for: `number`, `text`, `bool`; without it as the keys beside it say",
        "unit": "of a number", "range": "its least and its greatest value", "choices": "the texts that it is one of",
        "default": "the value of who says nothing",
    },
    asks="words",
)  # fmt: skip


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    otherwise = beside.get("unattended")
    said = otherwise.text if isinstance(otherwise, Scalar) else "fail"
    if said not in ("fail", "skip") and otherwise is not None:
        reader.wrong(otherwise, "choice", f"`unattended` is `{said[:40]}`", "`fail` or `skip`")
    values: dict[str, Any] = {"question": reader.text(scope, body, "what a person is to do"), "unattended": said}
    if not (asked := {key: beside[key] for key in _VALUE if key in beside}):
        return Given(values)
    about = _about(reader, body, beside, asked)
    if said == "skip" and about.default is None and otherwise is not None:
        reader.wrong(otherwise, "missing-key", "where nobody is there this has no value", "`default:` beside it")
    return Given(values | {"about": _plain(about)}, names={"": Name(about.kind, about.unit)})


def _about(reader: Reader, body: Node, beside: Mapping[str, Node], asked: Mapping[str, Node]) -> Parameter:
    """Return what is asked for, read as a parameter is."""
    called = beside.get("as")
    keys = {key: (Scalar(key, "", node.start, node.start), node) for key, node in asked.items()}
    about = read_parameter(
        reader, called.text if isinstance(called, Scalar) else "answer", Map(body.start, True, 0, keys)
    )
    if about.kind in ("numbers", "texts"):
        node = asked.get("kind") or asked.get("default") or body
        reader.wrong(node, "choice", "a person is asked for one value, not for a list", "`number`, `text` or `bool`")
    return about


def _plain(about: Parameter) -> dict[str, Any]:
    return {
        "kind": about.kind, "name": about.name, "unit": about.unit, "default": about.default, "low": about.low,
        "high": about.high, "choices": about.choices,
    }  # fmt: skip


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    about = given.get("about")
    if given["unattended"] == "skip" and not doing.attended:
        return {} if about is None else {"": about["default"]}
    question = Question(doing.step, str(given["question"]), unattended=given["unattended"], **(about or {}))
    answer = doing.ask(question)
    by = {"by": answer.by} if answer.by else {}
    if about is not None:
        return {"": answer.value, **by}
    if not answer.value:
        raise PicoError(error("declined", f"{answer.by or 'a person'} said no: {question.text}"))
    return by
