"""What expressions may speak of: the names of a bench with the kind of each, and their values as observed.

A component's name is text; `p2.pose.x`, `p2.angle` and so on are single names, so that a misspelt one is found before
anything is evaluated. A value that is not assured has none: whoever asks for it is told why.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable
from typing import Any

from pico.expressions import Function, Kind, words_of
from pico.kernels.measured import numbers_by
from pico.model.catalog import Tunable
from pico.model.measurement import Measurement, number_of
from pico.model.observation import Observation, ObservedComponent, slot_at
from pico.model.pose import Pose, angle_between
from pico.model.record import remembered
from pico.model.setup import Setup

POLICY_NAMES: dict[str, Kind] = {
    "plan": "any", "operations": "list", "components": "any", "lasers": "list", "lab": "any", "backend": "text",
    "fidelity": "text", "human_present": "bool", "audit": "any", "supervised": "text",
}  # fmt: skip
"""What rules of a policy speak of, besides the bench."""
OF_AN_IMAGE = ("peak", "mean")
"""What may be asked of a component that takes images."""
_KINDS: dict[str, Kind] = {"float": "number", "bool": "bool", "choice": "text"}
_PLACE: dict[str, Kind] = {
    "": "text", ".presence": "text", ".slot": "text", ".pose.x": "number", ".pose.y": "number", ".pose.yaw": "number",
}  # fmt: skip


def spoken_of(setup: Setup, texts: Iterable[str]) -> list[str]:
    """Return the components whose names occur in expressions."""
    words = words_of(texts)
    return sorted(words & (setup.lab.inventory.keys() | cameras_of(setup)))


def cameras_of(setup: Setup) -> set[str]:
    """Return the cameras over the bench, which expressions speak of for what they measure."""
    return {n for n in setup.lab.cameras if n not in setup.lab.inventory and setup.measurables_of(n)}


def names_of(setup: Setup, components: Iterable[str]) -> dict[str, Kind]:
    """Return the names that belong to components, with the kind of each."""
    names: dict[str, Kind] = {}
    for name in components:
        names |= {f"{name}.{m}": "number" for m in numbers_of(setup, name)}
        if name not in setup.lab.inventory:
            names[name] = "text"
            continue
        names |= {name + end: what for end, what in _PLACE.items()}
        names |= {f"{name}.{t}": _KINDS[tunable.datatype] for t, tunable in setup.type_of(name).tunables.items()}
    return names


@remembered
def numbers_of(setup: Setup, component: str) -> dict[str, str]:
    """Return the numbers that can be measured of a component or camera, each with the measurable that has it: those
    that are measurables themselves, and those of images and of kernels (`centroid.x`)."""
    found = {}
    for name, measurable in setup.measurables_of(component).items():
        if measurable.datatype == "float":
            found[name] = name
        elif measurable.datatype == "image":
            found = dict.fromkeys(OF_AN_IMAGE, name) | found
        elif measurable.datatype == "numbers" and measurable.kernel:
            found |= dict.fromkeys(numbers_by(measurable.kernel, name), name)
    return found


def measured_in(setup: Setup, texts: Iterable[str]) -> list[tuple[str, str]]:
    """Return what expressions speak of that must be measured: components or cameras, each with its measurable."""
    spoken = {word for text in texts for word in re.findall(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+", text)}
    found = ((name, numbers_of(setup, name).get(number)) for name, _, number in (w.partition(".") for w in spoken))
    return sorted({(name, measurable) for name, measurable in found if measurable})


def values_of(setup: Setup, seen: Observation, components: Collection[str]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the values of `names_of` as observed, and why each of the others has none."""
    values: dict[str, Any] = {}
    unknown: dict[str, str] = {}
    for name in components:
        for number, measurable in numbers_of(setup, name).items():
            _measured(f"{name}.{number}", number, seen.measurements.get(f"{name}.{measurable}"), values, unknown)
        if name not in setup.lab.inventory:
            values[name] = name
            continue
        part = seen.components.get(name) or ObservedComponent(presence="missing")
        values |= {name: name, f"{name}.presence": part.presence}
        _place(setup, name, part, values, unknown)
        kind = setup.type_of(name)
        for tunable, declared in kind.tunables.items():
            _value(f"{name}.{tunable}", declared, part, tunable, values, unknown)
    return values, unknown


def _measured(
    name: str, number: str, found: Measurement | None, values: dict[str, Any], unknown: dict[str, str]
) -> None:  # fmt: skip
    known = number_of(found, number) if found else None
    if found is None or known is None:
        unknown[name] = f"nobody measured {name}"
    elif found.doubt:
        unknown[name] = f"{name} was measured, but not all was assured: {found.doubt}"
    else:
        values[name] = known


def _place(
    setup: Setup, name: str, part: ObservedComponent, values: dict[str, Any], unknown: dict[str, str]
) -> None:  # fmt: skip
    why = _unplaced(setup, name, part)
    if why or part.pose is None:
        unknown |= dict.fromkeys([f"{name}.slot", *(f"{name}.pose.{a}" for a in ("x", "y", "yaw"))], why)
        return
    pose = part.pose
    values |= {f"{name}.pose.x": pose.x, f"{name}.pose.y": pose.y, f"{name}.pose.yaw": pose.yaw}
    values[f"{name}.slot"] = (slot_at(setup, pose) if setup.movable(name) else None) or ""


def _unplaced(setup: Setup, name: str, part: ObservedComponent) -> str:
    """Return why nobody can say where a component stands; empty where it is seen well enough."""
    if part.presence != "seen" or part.pose is None:
        return f"{name} is {part.presence if part.presence != 'seen' else 'missing'}"
    tolerance, seen = setup.type_of(name).pose.tolerance, part.uncertainty
    if seen.position > tolerance.position or seen.yaw > tolerance.yaw:
        allowed = f"{tolerance.position:g} mm and {tolerance.yaw:g} deg"
        return f"{name} is seen to {seen.position:.3g} mm and {seen.yaw:.3g} deg only, its tolerance is {allowed}"
    return ""


def _value(
    name: str, declared: Tunable, part: ObservedComponent, tunable: str, values: dict[str, Any], unknown: dict[str, str]
) -> None:  # fmt: skip
    live = part.values.get(tunable)
    if live is not None and live.status == "known" and live.value is not None:
        values[name] = live.value
    elif live is not None and live.status == "commanded":
        unknown[name] = f"{name} was commanded, and never read back"
    elif live is not None and declared.axis and declared.axis.kind == "homed":
        unknown[name] = f"nobody knows {name}: its axis must be homed"
    else:
        unknown[name] = f"nobody knows {name}"


def shown(text: str, values: dict[str, Any]) -> str:
    """Return the values that an expression speaks of: `p2.angle is 30, p2.pose.x is 520`."""
    spoken = [n for n in sorted(values) if "." in n and re.search(rf"(?<![\w.]){re.escape(n)}(?![\w.])", text)]
    return ", ".join(f"{n} is {_said(values[n])}" for n in spoken)


def _said(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, float | int) else f"`{value}`"


def functions_of(
    setup: Setup, seen: Observation | None = None, reaches: Callable[[str, str], bool] = lambda *_: False
) -> tuple[Function, ...]:
    """Return the functions of the language over a bench as observed; without `seen`, to check expressions only.

    `distance(a, b)`: between two components [mm]; `turned(a, b)`: from angle a to b, -180 to 180 [deg]; `abs(x)`;
    `inside(component, region)`: whether its origin lies in a region of the lab; `reaches(laser, component)`: whether
    the laser's beam comes to it, as whoever evaluates knows.
    """

    def pose(name: str) -> Pose:
        if name not in setup.lab.inventory:
            raise ValueError(f"there is no component `{name}`")
        part = (seen.components if seen else {}).get(name) or ObservedComponent(presence="missing")
        why = _unplaced(setup, name, part)
        if why or part.pose is None:
            raise ValueError(why)
        return part.pose

    return (
        Function("distance", ("text", "text"), "number", lambda a, b: pose(a).distance(pose(b))),
        Function("turned", ("number", "number"), "number", angle_between),
        Function("abs", ("number",), "number", abs),
        Function("inside", ("text", "text"), "bool", _inside(setup, pose)),
        Function("reaches", ("text", "text"), "bool", reaches),
    )


def _inside(setup: Setup, pose: Callable[[str], Pose]) -> Callable[[str, str], bool]:
    def inside(name: str, region: str) -> bool:
        if region not in setup.lab.regions:
            raise ValueError(f"there is no region `{region}`")
        area, at = setup.lab.regions[region].area, pose(name)
        return area.x[0] <= at.x <= area.x[1] and area.y[0] <= at.y <= area.y[1]

    return inside
