"""Whether goals make sense: tunables that a motor sets, bounds within their range, numbers that can be measured."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.expressions import Expression, ExpressionError, Language
from pico.manifest.checks.own_parameters import lasting, unattached
from pico.model.goal import Goal, Looks
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.vocabulary import cameras_of, functions_of, measured_in, names_of
from pico.optimize.registry import known


def goal_errors(setup: Setup, goals: Mapping[str, Goal]) -> Iterator[tuple[tuple[str, ...], Diagnostic]]:
    """Yield what is wrong with goals, each with where: the path of keys below `goals`."""
    for name, goal in goals.items():
        for tunable, bounds in goal.tunables.items():
            if wrong := _tunable(setup, tunable, bounds):
                yield (name, "tunables", tunable), wrong
        if wrong := _after(goals, setup, name):
            yield (name, "after"), wrong
        for address, value in (goal.during or {}).items():
            if wrong := _setting(setup, goal.tunables, address, value):
                yield (name, "during", address), wrong
        for key, wrong in (*look_errors(setup, goal.looks, goal.tunables), *_outputs(setup, goal)):
            yield (name, *key), wrong
        if goal.algorithm is not None and goal.algorithm not in known():
            hint = did_you_mean(goal.algorithm[:40], known()) or f"known: {', '.join(known())}"
            yield (name, "algorithm"), error("algorithm", f"there is no algorithm `{goal.algorithm[:40]}`", hint=hint)
        if goal.budget.measurements < 1 or goal.budget.seconds <= 0:
            yield (name, "budget"), error("value", "the budget is for nothing", hint="expected 1 measurement or more")
        if goal.budget.offline is not None and (wrong := unattached(goal.budget.offline)):
            yield (name, "budget"), wrong
        if goal.valid_for is not None and (wrong := lasting(goal.valid_for)):
            yield (name, "valid_for"), wrong


def require_goal(setup: Setup, name: str, goal: Goal) -> None:
    """Raise PicoError for what is wrong with a goal."""
    if found := [wrong for _, wrong in goal_errors(setup, {name: goal})]:
        raise PicoError(found)


def _tunable(setup: Setup, address: str, bounds: tuple[float, float]) -> Diagnostic | None:
    component, _, tunable = address.partition(".")
    if component not in setup.lab.inventory:
        return _no_component(setup, component)
    kinds = setup.type_of(component).tunables
    kind = kinds.get(tunable)
    if kind is None:
        return _no_such_tunable(kinds, component, tunable)
    if kind.datatype != "float" or kind.mover not in ("motor", "electronics"):
        text = f"{address} can't be searched: it is " + (
            f"set by {'an arm' if kind.mover == 'arm' else 'a person'}" if kind.datatype == "float" else "no number"
        )
        return error("goal", text, hint="a tunable that a motor or electronics set")
    low, high = bounds
    least, most = kind.range or (low, high)
    if not least <= low < high <= most:
        text = f"{address} may be set from {low:g} to {high:g} {kind.unit}".rstrip()
        return error("value", text, hint=f"within its range, the lower bound first: [{least:g}, {most:g}]")
    return None


def _after(goals: Mapping[str, Goal], setup: Setup, name: str) -> Diagnostic | None:
    """Return what is wrong with the goals that one comes after."""
    known = {**(setup.lab.goals or {}), **goals}
    seen, left = set[str](), list(goals[name].after or ())
    while left:
        one = left.pop()
        if one not in known:
            hint = did_you_mean(one[:40], known) or f"goals of the lab: {', '.join(known)}"
            return error("goal", f"{name} comes after `{one[:40]}`, which is no goal of the lab", hint=hint)
        if one == name:
            return error("goal", f"{name} comes after itself", hint="the first of them comes after none")
        left += [] if one in seen else known[one].after or ()
        seen.add(one)
    return None


def _no_component(setup: Setup, component: str) -> Diagnostic:
    hint = did_you_mean(component[:40], setup.lab.inventory) or "COMPONENT.TUNABLE: `ly_150.stage_y`"
    return error("unknown-component", f"there is no component `{component[:40]}` to be set", hint=hint)


def _no_such_tunable(kinds: Collection[str], component: str, tunable: str) -> Diagnostic:
    hint = did_you_mean(tunable[:40], kinds) or f"it has: {', '.join(kinds) or 'none'}"
    return error("unknown-tunable", f"{component} has no tunable `{tunable[:40]}`", hint=hint)


def look_errors(
    setup: Setup, looks: Looks | None, sought: Collection[str] = ()
) -> Iterator[tuple[tuple[str, ...], Diagnostic]]:  # fmt: skip
    """Yield what is wrong with looks, each with its path of keys; tunables that are `sought` can't be set."""
    for look, settings in (looks or {}).items():
        if look in setup.lab.inventory or look in setup.lab.cameras or not look.isidentifier():
            text = f"a look can't be called `{look[:40]}`"
            hint = "a word of its own, which no component has: `near`, `far`"
            yield ("looks", look), error("name", text, hint=hint)
        for address, value in settings.items():
            if wrong := _setting(setup, sought, address, value):
                yield ("looks", look, address), wrong


def _setting(setup: Setup, sought: Collection[str], address: str, value: Value) -> Diagnostic | None:
    """Return what is wrong with what a look sets."""
    component, _, tunable = address.partition(".")
    if component not in setup.lab.inventory:
        return _no_component(setup, component)
    kinds = setup.type_of(component).tunables
    if (kind := kinds.get(tunable)) is None:
        return _no_such_tunable(kinds, component, tunable)
    if address in sought:
        return error("goal", f"{address} is sought, and can't be set to look", hint="one of the two")
    if kind.mover not in ("motor", "electronics") or setup.type_of(component).optics.element == "source":
        text = f"a look can't set {address}"
        return error("goal", text, hint="a motor or electronics set it; lasers and their shutters stay as they are")
    low, high = kind.range or (-math.inf, math.inf)
    fits = {
        "float": isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high,
        "bool": isinstance(value, bool), "choice": value in (kind.choices or ()),
    }  # fmt: skip
    if not fits[kind.datatype]:
        known = f"from {low:g} to {high:g} {kind.unit}".rstrip() if kind.range else ", ".join(kind.choices or ())
        return error("value", f"{address} can't be {value}", hint=known or kind.datatype)
    return None


def _outputs(setup: Setup, goal: Goal) -> Iterator[tuple[tuple[str, ...], Diagnostic]]:
    language = _language(setup, goal)
    keyed: list[tuple[tuple[str, ...], str]] = [(("reach", text), text) for text in goal.reach or ()]
    keyed += [((goal.aim,), goal.expressions[0])] if goal.reach is None else []
    keyed += [(("signal",), goal.signal)] if goal.signal else []
    for key, text in keyed:
        try:
            endless = _endless(language, language.compile(text, "number"))
        except ExpressionError as exc:
            yield key, error("expression", f"`{text[:60]}` can't be measured: {exc}", hint=_SPEAK)
            continue
        if endless:
            wrong = f"`{text[:60]}` is {endless}, whatever is measured"
            yield key, error("expression", wrong, hint="what it divides by must not be 0")
        elif goal.looks and goal.seen_in(""):
            text = f"in which look is {goal.seen_in('')[0]} measured?"
            yield key, error("goal", text, hint=f"`{next(iter(goal.looks))}.{goal.seen_in('')[0]}`")
        elif not measured_in(setup, [goal.plain(text)]):
            yield key, error("expression", f"nothing is measured for `{text[:60]}`", hint=_SPEAK)
    for output in goal.reach or ():
        if goal.near(output) <= 0:
            hint = "`tolerance: 5`, or one for each: `tolerance: {cam.centroid.x: 5}`"
            yield _toleranced(goal, output), error("goal", f"how near is near enough to {output}?", hint=hint)


def _toleranced(goal: Goal, output: str) -> tuple[str, ...]:
    """Return where the tolerance of an output stands, or what it is missing of."""
    if isinstance(goal.tolerance, Mapping):
        return ("tolerance", output) if output in goal.tolerance else ("tolerance",)
    return ("reach", output) if goal.tolerance is None else ("tolerance",)


def _endless(language: Language, expression: Expression) -> str:
    """Return what an expression is that is a number for no readings: infinite, or none at all; empty for any other."""
    found = []
    for n, scale in enumerate((1.0, 0.01, 300.0)):
        numbers = sorted(name for name, kind in language.names.items() if kind == "number")
        try:
            found.append(expression.evaluate({name: scale * (1 + (n + k) % 7 / 5) for k, name in enumerate(numbers)}))
        except ExpressionError:  # it speaks of more than numbers, or has no result just there
            return ""
    if any(map(math.isfinite, found)):
        return ""
    return "no number" if any(map(math.isnan, found)) else "infinite"


def _language(setup: Setup, goal: Goal) -> Language:
    names = names_of(setup, [*setup.lab.inventory, *cameras_of(setup)])
    looked = {f"{look}.{name}": kind for look in goal.looks or () for name, kind in names.items() if "." in name}
    return Language({**names, **looked}, functions_of(setup))


_SPEAK = "numbers that are measured, by address: `cam.centroid.x`, `pd.voltage`; `pico catalog show TYPE` lists them"
