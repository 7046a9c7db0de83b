"""What a goal's numbers cannot tell of its tunables, by the nominal model of the bench: said before a search."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from pico.diagnostics import Diagnostic, warning
from pico.model.catalog import ComponentType
from pico.model.goal import Goal
from pico.model.pose import Pose, short
from pico.model.setup import Setup
from pico.model.vocabulary import measured_in
from pico.optics.light import Light
from pico.optics.nominal.bench import Nominal

_TRIED = (0.0, 0.21, 0.5, 0.83, 1.0)
"""Places within its bounds at which a tunable is tried, as shares: none of them is half a period from another."""
_CHANGES = 1e-4
"""The share of a number, of a power or of a radius, by which it must change to tell anything."""
_POWERS = ("power", "voltage", "light")
_ANALYZERS = ("polarizer", "wollaston", "isolator", "prism", "grating")


def cautions(
    setup: Setup, poses: Mapping[str, Pose], values: Mapping[str, Mapping[str, Any]], goal: Goal
) -> tuple[Diagnostic, ...]:
    """Return a warning for each tunable of a goal that stands outside of where it is searched, and for each that
    changes nothing of what the goal measures, by the way of light among parts at `poses` with tunables at `values`.

    Of the second nothing is said if the model cannot tell: without light, behind a trace that was cut, where beams of
    one source interfere, of a fiber, whose coupling has more to it than power, or of a goal that changes the bench to
    look at it.
    """
    found = [*_outside(setup, values, goal)]
    if goal.looks:
        return tuple(found)
    during: dict[str, dict[str, Any]] = {name: dict(own) for name, own in values.items()}
    for address, value in (goal.during or {}).items():
        during.setdefault(address.partition(".")[0], {})[address.partition(".")[2]] = value
    nominal, numbers = Nominal(setup, poses, during), measured_in(setup, goal.texts)
    if numbers and all(_told(setup, nominal.light(), name) for name, _ in numbers):
        for address, bounds in goal.tunables.items():
            if not any(_moves(nominal, address, bounds, name, number) for name, number in numbers):
                found.append(_insensitive(nominal, address, bounds, numbers))
    return tuple(found)


def _outside(setup: Setup, values: Mapping[str, Mapping[str, Any]], goal: Goal) -> Iterator[Diagnostic]:
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        here, kind = values.get(component, {}).get(tunable), setup.type_of(component).tunables[tunable]
        if not isinstance(here, int | float) or isinstance(here, bool) or low <= here <= high or kind.period:
            continue
        text = f"{address} is at {short(here)} {kind.unit}, and only {short(low)} to {short(high)} is searched"
        hint = f"widen its bounds in the goal, or bring it there first: `pico set {address}={short((low + high) / 2)}`"
        yield warning("search-range", text, hint=hint, address=address)


def _told(setup: Setup, light: Light, detector: str) -> bool:
    """Whether the model can tell what a detector reads."""
    if detector not in light.parts or light.unfollowed(detector):
        return False
    sources = [a.beam.source for a in light.at(detector)]
    return (
        bool(sources) and len(set(sources)) == len(sources) and "mode_radius" not in setup.type_of(detector).parameters
    )


def _moves(nominal: Nominal, address: str, bounds: tuple[float, float], detector: str, measurable: str) -> bool:
    """Whether a number changes as a tunable goes through its bounds."""
    read = [
        _read(_set(nominal, address, bounds[0] + share * (bounds[1] - bounds[0])).light(), detector, measurable)
        for share in _TRIED
    ]
    if any(one is None for one in read):
        return True
    rows = np.array(read)
    scale = np.maximum(np.abs(rows).max(axis=0), rows[:, -1].max() if rows.shape[1] > 1 else 0.0)
    return bool((np.ptp(rows, axis=0) > _CHANGES * scale).any())


def _set(nominal: Nominal, address: str, value: float) -> Nominal:
    component, _, tunable = address.partition(".")
    own = {**nominal.values.get(component, {}), tunable: value}
    return replace(nominal, values={**nominal.values, component: own}, near=(nominal.light(), frozenset({component})))


def _read(light: Light, detector: str, measurable: str) -> Sequence[float] | None:
    """The powers of a detector's beams [mW]; of other numbers than powers also their middles and radii [mm], the
    largest radius last. None without light."""
    arrivals = light.at(detector)
    if not arrivals or light.unfollowed(detector):
        return None
    power = [sum(a.power for a in arrivals)]
    if measurable.partition(" ")[0] in _POWERS:
        return power
    widest = max(float(a.beam.widths[0]) for a in arrivals)
    return [*(v for a in arrivals for v in (*a.center, float(a.beam.widths[1]))), *power, widest]


def _insensitive(
    nominal: Nominal, address: str, bounds: tuple[float, float], numbers: Sequence[tuple[str, str]]
) -> Diagnostic:
    component, _, tunable = address.partition(".")
    kind, detectors = nominal.setup.type_of(component), list(dict.fromkeys(name for name, _ in numbers))
    names, what = " and ".join(detectors), " and ".join(f"{name}.{number}" for name, number in numbers)
    turned = kind.optics.element in ("polarizer", "waveplate") and tunable == "angle"
    if turned and not _analyzed(nominal.light(), component, detectors):
        text, hint = f"no polarizer stands between {component} and {names}", f"put a polarizer before {names}"
        return warning("insensitive", f"{text}: {what} is the same at every {address}", hint=hint, address=address)
    unit = kind.tunables[tunable].unit
    text = f"{what} does not change with {address} from {short(bounds[0])} to {short(bounds[1])} {unit}".rstrip()
    hint = "leave it out of the goal, or measure something that it changes; `pico beam` shows the way of the light"
    return warning("insensitive", text, hint=hint, address=address)


def _analyzed(light: Light, component: str, detectors: Collection[str]) -> bool:
    """Whether something behind a part, on the way to a detector, takes light by its polarization."""
    for number, crossing in enumerate(light.crossings):
        way = [c.component for c in light.way(number)] if crossing.component in detectors else []
        behind = way[way.index(component) + 1 :] if component in way else []
        if any(_analyzes(light.parts[name].kind) for name in behind if name):
            return True
    return False


def _analyzes(kind: ComponentType) -> bool:
    polarizing = kind.parameters.get("polarizing")
    return kind.optics.element in _ANALYZERS or (polarizing is not None and polarizing.value is True)
