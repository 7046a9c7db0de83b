"""`optimize: centred`: light is brought to a goal of the lab, or to a ready-made one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.manifest.text.tree import Node
from pico.model.plan import Plan
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader, scalar_texts
from pico.recipes.recipe import Name
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind(
    "light is brought to a goal", "optimize: center ly_150 cam",
    keys={"required": "whether the recipe fails where it is not met (true)"}, within=True,
)  # fmt: skip


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    listed = scalar_texts(body)
    words = [w for _, text in listed or () for w in text.split()]
    required = reader.flag(scope, beside["required"], "required") if "required" in beside else True
    if not words:
        reader.wrong(body, "type", "`optimize` takes a goal", f"`{KIND.example}`")
    else:
        reader.goal(body, words)
    names = {"met": Name("bool"), "measurements": Name("number")}
    return Given({"goal": tuple(words), "required": required}, names=names)


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be done."""
    goals = doing.bench.goals
    return goals.plan(goals.chosen(given["goal"]))


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    from pico.bench.goals import optimized

    events: list[Any] = []
    shown = doing.show

    def heard(event: Any) -> None:
        events.append(event)
        shown(event)

    doing.show = heard
    try:
        doing.run(plan(doing, given))
    finally:
        doing.show = shown
    found = optimized(events)
    if given["required"] and not found.met:
        text = f"{' '.join(given['goal'])} was not met: {found.why}"
        raise PicoError(error("goal", text, hint="`required: false` goes on without it"), ExitCode.EXPECTATION)
    return {"met": found.met, "measurements": float(found.measurements)}
