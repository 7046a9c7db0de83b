"""Whether what a part has of its own, parameters and how it is restored, is of what its type has."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial

from pico.base import clock
from pico.diagnostics import Diagnostic, SourceRange, did_you_mean, error
from pico.manifest.checks.parameters import wrong_parameters
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType, Restore, value_of
from pico.model.lab import Known
from pico.model.quantities import QuantityError, Value, convert
from pico.model.setup import Setup


def check_own_parameters(document: Document, setup: Setup) -> Iterator[Diagnostic]:
    """Yield what is wrong with the parameters of the parts of a lab, each at its place in the document."""
    for name, part in setup.lab.inventory.items():
        if part.parameters and part.type in setup.catalog:
            yield from _parameters(document, setup, name)
        if part.measured and part.type in setup.catalog:
            yield from _measured(document, setup, name, part.measured)
        if part.restore and part.type in setup.catalog:
            yield from _restores(document, setup, name, part.restore)


def _measured(document: Document, setup: Setup, name: str, known: Mapping[str, Known]) -> Iterator[Diagnostic]:
    part = setup.lab.inventory[name]
    own, kinds = part.parameters or {}, setup.catalog[part.type].parameters
    for number, one in known.items():
        at = partial(where, document, "inventory", name, "measured", number)
        if number not in own and number not in part.calibration:
            text = f"{name} has no `{number[:40]}` of its own that could have been measured"
            hint = did_you_mean(number[:40], (*own, *part.calibration)) or f"say it under `parameters:` of {name} first"
            yield error("value", text, hint=hint, source=where_key(document, "inventory", name, "measured", number))
            continue
        try:
            clock.parse(one.at)
        except ValueError:
            yield error("value", f"`{one.at[:40]}` is no date", hint="`2026-11-20`", source=at("at"))
        if one.valid_for is not None and (wrong := lasting(one.valid_for)):
            yield replace(wrong, source=at("valid_for"))
        unit = kinds[number].unit if number in own and number in kinds else ""
        yield from _sigma(name, number, one, unit, at("sigma"))


def _sigma(name: str, number: str, one: Known, unit: str, at: SourceRange) -> Iterator[Diagnostic]:
    try:
        sigma = convert(one.sigma, unit) if one.sigma is not None else 0.0
    except QuantityError as exc:
        yield error("value", f"sigma of `{number}` of {name}: {exc}", source=at)
        return
    if isinstance(sigma, bool) or not isinstance(sigma, int | float) or sigma < 0:
        yield error("value", f"sigma of `{number}` of {name} is {one.sigma}", hint="0 or more", source=at)


def lasting(text: str, what: str = "valid_for") -> Diagnostic | None:
    """Return what is wrong with how long something counts; None for nothing."""
    try:
        return None if convert(text, "s") > 0 else error("value", f"`{text}` is no time", hint="`12 h`")
    except QuantityError as exc:
        return error("value", f"{what}: {exc}", hint="`12 h`, `365 d`")


def unattached(seconds: float) -> Diagnostic | None:
    """Return what is wrong with how long a bench may go on by itself [s]; None for nothing."""
    from pico.control.gate import OFFLINE

    if 0.0 <= seconds <= OFFLINE:
        return None
    text = f"a bench goes on by itself for {OFFLINE:g} s at most, not for {seconds:g} s"
    return error("value", text, hint=f"`offline` is 0 to {OFFLINE:g}, in seconds")


def _restores(document: Document, setup: Setup, name: str, given: Mapping[str, Restore]) -> Iterator[Diagnostic]:
    kinds, goals = setup.catalog[setup.lab.inventory[name].type].tunables, setup.lab.goals or {}
    for tunable, one in given.items():
        if tunable not in kinds:
            hint = did_you_mean(tunable[:40], kinds) or f"it has: {', '.join(kinds) or 'none'}"
            at = where_key(document, "inventory", name, "restore", tunable)
            yield error("unknown-tunable", f"{name} has no tunable `{tunable[:40]}`", hint=hint, source=at)
        elif kinds[tunable].restore.kind == "request" != one.kind:
            text = f"{name}.{tunable} is light that is asked for; it stays a request"
            at = where_key(document, "inventory", name, "restore", tunable)
            yield error("request", text, hint="leave it out", source=at)
        if one.goal is not None and one.goal not in goals:
            hint = did_you_mean(one.goal[:40], goals) or f"goals of this lab: {', '.join(goals) or 'none'}"
            at = where(document, "inventory", name, "restore", tunable, "goal")
            yield error("goal", f"this lab has no goal `{one.goal[:40]}`", hint=hint, source=at)


def _parameters(document: Document, setup: Setup, name: str) -> Iterator[Diagnostic]:
    part = setup.lab.inventory[name]
    kind, own = setup.catalog[part.type], part.parameters or {}
    places = partial(where, document, "inventory", name, "parameters")
    wrong = False
    for parameter, given in own.items():
        at = where_key(document, "inventory", name, "parameters", parameter)
        try:
            value_of(kind.parameters[parameter], given)
        except KeyError:
            wrong, text = True, f"{name} ({kind.name}) has no parameter `{parameter[:40]}`"
            hint = did_you_mean(parameter[:40], kind.parameters) or f"known: {', '.join(kind.parameters) or 'none'}"
            yield error("unknown-parameter", text, hint=hint, source=at)
        except QuantityError as exc:
            wrong, unit = True, kind.parameters[parameter].unit
            hint = f"its type has {kind.parameters[parameter].value} {unit}".rstrip()
            yield error("value", f"`{parameter}` of {name}: {exc}", hint=hint, source=places(parameter))
    if not wrong:
        known = {(d.code, d.summary) for d in wrong_parameters(kind, lambda _: None)}
        found = wrong_parameters(setup.type_of(name), places)
        yield from (d for d in found if (d.code, d.summary) not in known)
        yield from _radius_and_focal_length(kind, own, places, name)


def _radius_and_focal_length(
    kind: ComponentType, given: Mapping[str, Value], places: Callable[[str], SourceRange], name: str
) -> Iterator[Diagnostic]:
    radius = "radius_of_curvature"
    if kind.optics.element == "lens" and radius in given and "focal_length" not in given:
        text = f"of {name} `{radius}` is its own, and `focal_length` that of {kind.name}: they differ"
        hint = "give its `focal_length`, from which the radius follows; or both"
        yield error("value", text, hint=hint, source=places(radius))
