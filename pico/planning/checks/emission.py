"""Which operations let light out, of which lasers, and whether anybody lets them: one rule for planner and edge.

Lasers of class 1 and 2 may emit; one above that only by a licence of its class, as an observation has them
(`Observation.licences`): an arming by a person, or a waiver of the lab where nothing is emitted.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pico.diagnostics import Diagnostic, error, warning
from pico.model.arming import LaserClass, within
from pico.model.observation import Observation
from pico.model.operation import Operation, searched_by
from pico.model.plan import UNARMED
from pico.model.setup import Setup
from pico.optics.audit.lasers import laser_class
from pico.optics.audit.limits import above_class_2

SEARCHING = ("optimize", "teleoperate", "survey")
"""Primitives that set the tunables which they name, within bounds."""


def is_dark(tunable: str, value: object) -> bool:
    """Return whether a tunable of a source or a shutter lets no light out at a value; only what it surely means counts,
    for a device may take anything else otherwise."""
    if tunable == "shutter":
        return value == "closed"
    return value is False if tunable == "emission" else _number(value) and value == 0


def lets_out(setup: Setup, op: Operation) -> bool:
    """Return whether an operation lets light out: opens a shutter, sets a laser to anything but dark, searches one of
    its tunables, or does to it what nobody can tell."""
    if op.primitive in SEARCHING:
        return any(True for _ in _searched(setup, op))
    if op.component not in setup.lab.inventory:
        return False
    element = setup.type_of(op.component).optics.element
    tunable = op.arguments.get("tunable")
    if op.primitive in ("set", "operator"):
        dark = is_dark(str(tunable), op.arguments.get("to"))
        return not dark and (tunable == "shutter" or (element == "source" and tunable is not None))
    gates = element == "source" or (element == "shutter" and "shutter" in setup.type_of(op.component).tunables)
    return gates and op.kind.mutating and op.kind.by == "device"


def uncovers(setup: Setup, op: Operation) -> bool:
    """Return whether an operation moves a shutter that stands on the table: out of a beam that it may be all that
    closes."""
    if op.component not in setup.lab.inventory or not (op.kind.carries or (op.kind.by_hand and "to" in op.arguments)):
        return False
    kind = setup.type_of(op.component)
    return kind.optics.element == "shutter" and "shutter" in kind.tunables and "tunable" not in op.arguments


def _searched(setup: Setup, op: Operation) -> Iterator[tuple[str, str, float]]:
    """Yield the tunables of sources and shutters that are searched or steered, each with the most that it is set to."""
    for address, bounds in searched_by(op.arguments).items():
        component, _, tunable = address.partition(".")
        known = component in setup.lab.inventory
        if known and setup.type_of(component).optics.element in ("source", "shutter"):
            yield component, tunable, max(bounds) if bounds else math.inf


def let_out(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> dict[str, LaserClass]:
    """Return the lasers that operations let light out of, at some time, each with the class of what it then emits. What
    nobody knows counts as open and on, and a power as the highest that it has or gets."""
    opening = [op for op in operations if lets_out(setup, op) or uncovers(setup, op)]
    if not opening:
        return {}
    values = seen.known_values
    if not any(lets_out(setup, op) for op in opening):  # what is shut for the while that a shutter is moved stays so
        for op in operations:
            tunable = str(op.arguments.get("tunable"))
            if op.primitive == "set" and is_dark(tunable, op.arguments.get("to")):
                values.setdefault(op.component, {})[tunable] = op.arguments["to"]
    for op in opening:
        for component, tunable, to in _settings(setup, op):
            own = values.setdefault(component, {})
            before = own.get(tunable)
            own[tunable] = max(before, to) if _number(before) and _number(to) else to
    touched = {component for op in opening for component, _, _ in _settings(setup, op)} | {o.component for o in opening}
    sources = [n for n in sorted(setup.lab.inventory) if setup.type_of(n).optics.element == "source"]
    apart = any(name not in sources for name in touched)
    return {
        name: laser_class(setup, name, values.get(name, {}))[0]
        for name in sources
        if (apart or name in touched) and may_shine(setup, seen, name, values.get(name, {}))
    }


def _settings(setup: Setup, op: Operation) -> Iterator[tuple[str, str, Any]]:
    if op.primitive in SEARCHING:
        yield from _searched(setup, op)
        return
    kind = setup.type_of(op.component).tunables.get(str(op.arguments.get("tunable")))
    if uncovers(setup, op):
        return
    if op.primitive in ("set", "operator"):
        yield op.component, str(op.arguments.get("tunable")), op.arguments.get("to")
    elif kind is not None:  # where it ends nobody knows beforehand
        yield op.component, str(op.arguments.get("tunable")), kind.range[1] if kind.range else "anything"


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def may_shine(setup: Setup, seen: Observation, laser: str, values: Mapping[str, Any]) -> bool:
    """Return whether a laser with these tunables may emit, for all that is known; not one that is not there."""
    part = seen.components.get(laser)
    if part is None or part.presence == "missing":
        return False
    return values.get("emission") is not False and values.get("shutter") != "closed"


def unlicensed(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> dict[str, LaserClass]:
    """Return the lasers that operations let light out of and nobody lets, each with its class."""
    found = let_out(setup, seen, operations)
    return {name: of for name, of in found.items() if not licensed(seen, name, of)}


def licensed(seen: Observation, laser: str, of: LaserClass) -> bool:
    """Return whether a laser may emit as of a class."""
    if not above_class_2(of):
        return True
    own = (seen.licences or {}).get(laser)
    return own is not None and within(of, own.laser_class)


def why_not(seen: Observation, laser: str, of: LaserClass) -> str:
    """Return in words why a laser may not emit as of a class."""
    own = (seen.licences or {}).get(laser)
    if own is None:
        return "nobody has armed it"
    if own.withheld:
        return own.withheld
    return f"{own.by} armed it for class {own.laser_class} only" if own.by else f"it is no more than {own.laser_class}"


def opening_hint(laser: str) -> str:
    """Return what lets a laser emit."""
    return (
        f"`pico laser arm {laser}` opens it, once the beam audit passes; "
        "a lab may waive that in its twin: `policy: {arming: {waived: [kinematic, physics]}}`"
    )


def refused(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> list[Diagnostic]:
    """Return an error for each laser that operations let light out of and nobody lets."""
    return [
        error(UNARMED, f"{name} (class {of}) stays shut: {why_not(seen, name, of)}", hint=opening_hint(name),
              address=name)
        for name, of in unlicensed(setup, seen, operations).items()
    ]  # fmt: skip


def uncovered(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> list[Diagnostic]:
    """Return an error for each laser that nobody lets emit and that is shut by a shutter alone which is moved."""
    return refused(setup, seen, [op for op in operations if not lets_out(setup, op)])


def above(setup: Setup, seen: Observation, operations: Sequence[Operation], most: LaserClass) -> list[Diagnostic]:
    """Return an error for each laser that operations let light out of, and must not where nobody is there."""
    out = let_out(setup, seen, operations)
    return [one for name, of in out.items() for one in emits_alone(seen, name, of, most)]


def emits_alone(seen: Observation, laser: str, of: LaserClass, most: LaserClass) -> list[Diagnostic]:
    """Return why a laser must not emit as of a class where nobody is there, and `most` is the highest that was
    stated."""
    if not within(of, most):
        text = f"{laser} emits as class {of}; the recipe states {most} at the most"
        return [error("unattended", text, address=laser)]
    licence = (seen.licences or {}).get(laser)
    if licence is None or not licence.by or licence.unattended:
        return []
    text, hint = f"{licence.by} armed {laser} as one who is there", f"`pico laser arm {laser} --unattended`"
    return [error("unattended", text, hint=hint, address=laser)]


def left_shut(seen: Observation, lasers: Mapping[str, LaserClass]) -> tuple[Diagnostic, ...]:
    """Return a warning for each laser that a plan leaves shut though its light is asked for."""
    return tuple(
        warning(UNARMED, f"{name} (class {of}) stays dark: {why_not(seen, name, of)}", hint=opening_hint(name),
                address=name)
        for name, of in sorted(lasers.items())
    )  # fmt: skip
