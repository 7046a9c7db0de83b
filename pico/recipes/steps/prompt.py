"""`prompt: Put the sample in.`: a person does something and says so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.manifest.text.tree import Node, Scalar
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind(
    "a person does something and says so", "prompt: Put the sample in.",
    keys={"unattended": "what is done where nobody is there: `fail`, or `skip`"}, asks=True,
)  # fmt: skip


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    otherwise = beside.get("unattended")
    said = otherwise.text if isinstance(otherwise, Scalar) else "fail"
    if said not in ("fail", "skip") and otherwise is not None:
        reader.wrong(otherwise, "choice", f"`unattended` is `{said[:40]}`", "`fail` or `skip`")
    return Given({"question": reader.text(scope, body, "what a person is to do"), "unattended": said})


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    if given["unattended"] == "skip" and not doing.attended:
        return {}
    if not doing.ask(str(given["question"])):
        raise PicoError(error("declined", f"a person said no: {given['question']}"))
    return {}
