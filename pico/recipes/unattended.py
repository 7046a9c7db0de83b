"""What a recipe states of how it runs where nobody is there: the highest laser class, the hours, what stops it, and how
the bench is left."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from datetime import time
from typing import get_args

from pico.diagnostics import Diagnostic, did_you_mean, error
from pico.manifest.text.tree import List, Map, Node, Scalar
from pico.manifest.wording import shown
from pico.model.arming import LaserClass
from pico.model.trace.unattended import ENDS
from pico.model.vocabulary import measured_in, numbers_of
from pico.recipes.reader import NOTHING, Reader, scalar_texts
from pico.recipes.recipe import EVERY, Act, Call, Name, Recipe, Step, Stop, Unattended, blocks
from pico.recipes.registry import step_file
from pico.recipes.scope import Scope

KEYS = ("laser_class", "hours", "stop", "every", "end")
_CLASSES: tuple[str, ...] = get_args(LaserClass)
_TIME = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)")
_EXAMPLE = (
    "`unattended: {laser_class: 3R, hours: {from: 22:00, to: 6:00}, stop: [{when: meter.power < 1}], end: [shut]}`"
)


def read_unattended(
    reader: Reader, names: Mapping[str, Name], own: Mapping[str, Name], node: Node | None, steps: Sequence[Step]
) -> Unattended | None:  # fmt: skip
    """Return what a recipe states, None where it states nothing; what is wrong with it is said."""
    if node is None:
        return None
    if not isinstance(node, Map):
        reader.wrong(node, "type", "`unattended` is a mapping", _EXAMPLE)
        return None
    reader.keys(node, KEYS, "`unattended`")
    for key in ("laser_class", "hours", "stop", "end"):
        if key not in node.entries:
            hint = "`stop: []` where nothing is to" if key == "stop" else _EXAMPLE
            reader.wrong(node, "missing-key", f"`unattended` does not state `{key}`", hint)
    of, hours = _class(reader, node.get("laser_class")), _hours(reader, node.get("hours"))
    stops = tuple(_stops(reader, names, own, node.get("stop")))
    every = node.get("every")
    seconds = reader.number(Scope({}, {}), every, "`every`", "s", 1.0, 86_400.0) if every else None
    _asking(reader, steps)
    if of is None or hours is None or seconds is NOTHING:
        return None
    return Unattended(of, *hours, stops, float(seconds.literal) if seconds else EVERY, _end(reader, node.get("end")))


def _class(reader: Reader, node: Node | None) -> LaserClass | None:
    if node is None:
        return None
    word = node.text if isinstance(node, Scalar) else ""
    if word not in _CLASSES:
        reader.wrong(node, "choice", f"`{word[:40]}` is no class of lasers", f"one of {', '.join(_CLASSES)}")
        return None
    return word  # type: ignore[return-value]


def _hours(reader: Reader, node: Node | None) -> tuple[time, time] | None:
    if node is None:
        return None
    found = []
    for key in ("from", "to"):
        value = node.get(key) if isinstance(node, Map) else None
        matched = _TIME.fullmatch(value.text) if isinstance(value, Scalar) else None
        if matched is None:
            what = f"`{key}` of the hours is {shown(value.text)}" if isinstance(value, Scalar) else f"no `{key}`"
            reader.wrong(value or node, "type", f"{what}: no time of day", "`hours: {from: 22:00, to: 6:00}`")
            return None
        found.append(time(int(matched[1]), int(matched[2])))
    if found[0] == found[1]:
        reader.wrong(node, "range", "the hours end when they begin", "`hours: {from: 22:00, to: 6:00}`")
        return None
    reader.keys(node, ("from", "to"), "the hours")  # type: ignore[arg-type]
    return found[0], found[1]


def _stops(
    reader: Reader, names: Mapping[str, Name], own: Mapping[str, Name], node: Node | None
) -> Iterator[Stop]:  # fmt: skip
    example = "`stop: [{when: meter.power < 1, message: the reference is dark}, {lost: centred}]`"
    if node is not None and not isinstance(node, List):
        reader.wrong(node, "type", "`stop` is a list of what stops the run", example)
    measured = [f"{p}.{n}" for p in (*reader.setup.lab.inventory, *reader.setup.lab.cameras)
                for n in numbers_of(reader.setup, p)]  # fmt: skip
    scope = Scope(names, own, measured)
    for item in node.items if isinstance(node, List) else ():
        entries = item.entries if isinstance(item, Map) else {}
        if len({"when", "lost"} & entries.keys()) != 1:
            reader.wrong(item, "type", "what stops a run is a condition `when`, or a goal that is `lost`", example)
            continue
        assert isinstance(item, Map)
        reader.keys(item, ("when", "lost", "message"), "what stops a run")
        yield from _stop(reader, scope, item)


def _stop(reader: Reader, scope: Scope, item: Map) -> Iterator[Stop]:
    message, (at, body) = item.get("message"), item.entries.get("when") or item.entries["lost"]
    said = message.text if isinstance(message, Scalar) else ""
    if "lost" in item.entries:
        goals, word = reader.setup.lab.goals or {}, body.text if isinstance(body, Scalar) else ""
        if word not in goals:
            hint = did_you_mean(word[:40], goals) or f"goals of this lab: {', '.join(goals) or 'none'}"
            reader.wrong(body, "goal", f"{reader.setup.lab.name} has no goal `{word[:40]}`", hint)
        yield Stop(said or f"{word} is lost", lost=word, source=reader.at(at))
        return
    when = reader.flag(scope, body, "what stops the run")
    of = tuple(f"{p}.{m}" for p, m in measured_in(reader.setup, sorted(when.words())))
    if when is not NOTHING and all(reader.measurable(body, address) for address in of):
        text = body.text if isinstance(body, Scalar) else ""
        yield Stop(said or f"{text.strip()}", when, of, source=reader.at(at))


def _end(reader: Reader, node: Node | None) -> tuple[str, ...]:
    listed = scalar_texts(node) if node is not None else ()
    if listed is None:
        reader.wrong(node, "type", "`end` is a list", f"`end: [{', '.join(ENDS)}]`")  # type: ignore[arg-type]
    for at, word in listed or ():
        if word not in ENDS:
            hint = did_you_mean(word[:40], ENDS) or f"of {', '.join(ENDS)}"
            reader.wrong(at, "choice", f"no bench is left `{word[:40]}`", hint)
    return tuple(word for word in ENDS if word in {text for _, text in listed or ()})


def _asking(reader: Reader, steps: Sequence[Step]) -> None:
    """Say which steps wait for a person, who is not there."""
    hint = "`unattended: skip` beside a prompt, or no section `unattended`"
    for step in _waiting(steps):
        text = f"`{step.title}` waits for a person, and `unattended` says that nobody is there"
        reader.found.append(error("unattended", text, hint=hint, source=step.source))


def asking(recipe: Recipe, by: str = "") -> list[Diagnostic]:
    """Return an error for each step of a recipe that can't be done where nobody is there; see `waiting`."""
    hint = "run it at a terminal; or `unattended: skip` beside a prompt that may be left out"
    return [
        error("unattended", f"`{step.title}` waits for a person, and nobody is there", hint=hint, source=step.source)
        for step in _waiting((*recipe.steps, *recipe.finally_), by)
    ]


def waiting(recipe: Recipe, by: str = "") -> tuple[str, ...]:
    """Return the steps of a recipe that wait for a person, as they are written; `by`: who answers in `words`, or has
    the `keys` of a terminal, empty for both."""
    return tuple(step.title for step in _waiting((*recipe.steps, *recipe.finally_), by))


def _waiting(steps: Sequence[Step], by: str = "") -> Iterator[Act]:
    """Yield the steps that wait for a person whoever is there."""
    for step in _all(steps):
        asks = step_file(step.kind).KIND.asks
        if asks and by in ("", asks) and step.given.get("unattended") != "skip":
            yield step


def _all(steps: Sequence[Step]) -> Iterator[Act]:
    """Yield the acts of steps, with those of recipes that are called."""
    for step in steps:
        if isinstance(step, Act):
            yield step
        if isinstance(step, Call) and step.recipe is not None:
            yield from _all((*step.recipe.steps, *step.recipe.finally_))
        for _, inner in blocks(step):
            yield from _all(inner)
