"""Whether the tunables of a goal span what placing parts may do to it, by the nominal model of the state at hand."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pico.diagnostics import Diagnostic, error
from pico.geometry.seat import scatter_of
from pico.manifest.checks.goals import goal_errors
from pico.manifest.load import Manifests
from pico.manifest.text.places import where
from pico.model.goal import Goal
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.optics.nominal.bench import PLACED, Array, Nominal

SIGMAS = 3.0
"""How many standard deviations of placement a goal is to be reached from."""
DIRECTIONS = 90
"""In how many directions, over half a turn, two numbers are looked at together."""
_STEERS = ("tip", "tilt", "stage_y", "stage_z", "stage_x")


@dataclass(frozen=True)
class Span:
    """What placing parts may do to a goal's numbers (`spread`, (n, k), a column for each part and way, one standard
    deviation), and what its tunables do (`tuned`, (n, m), per unit) within `bounds` (m, 2) of where they are."""

    goal: str
    numbers: tuple[str, ...]
    spread: Array
    tuned: Array
    bounds: Array

    def needed(self, way: Array) -> float:
        """Return how far along a direction (n,) of its numbers placing parts leads, `SIGMAS` standard deviations."""
        return SIGMAS * float(np.linalg.norm(way @ self.spread))

    def able(self, way: Array) -> float:
        """Return how far along a direction (n,) of its numbers its tunables lead at most, within their bounds."""
        return float(np.max((way @ self.tuned)[:, None] * self.bounds, axis=1, initial=0.0).sum())


def check_spans(read: Manifests) -> tuple[Diagnostic, ...]:
    """Return the goals of a lab whose tunables do not span what placing parts may do to them, each at its place; of a
    state in which light does not come through what a goal tunes to where it is measured nothing is said."""
    setup, state = read.require()
    lab = read.documents.get("Lab", ())
    found = []
    for name, goal in (setup.lab.goals or {}).items():
        if any(goal_errors(setup, {name: goal})):
            continue  # said by itself
        at = where(lab[0], "goals", name, "tunables") if lab else None
        found += [replace(one, source=at) for one in missing(setup, state, name, goal)]
    return tuple(found)


def missing(setup: Setup, state: LabState, name: str, goal: Goal) -> Iterator[Diagnostic]:
    """Yield what the tunables of a goal lack in a state; nothing where the model cannot tell."""
    nominal = nominal_of(setup, state)
    span = span_of(nominal, name, goal)
    if span is None:
        return
    for number, way in enumerate(np.eye(len(span.numbers))):
        needed, able = span.needed(way), _both(span, way)
        if able + goal.near(span.numbers[number]) < needed:
            yield _short(nominal, span, goal, span.numbers[number], needed, able)
            return
    for way in _directions(len(span.numbers)):
        near = math.hypot(*(share * goal.near(n) for share, n in zip(way, span.numbers, strict=True)))
        if _both(span, way) + near < span.needed(way):
            text = f"the tunables of {name} move {' and '.join(span.numbers)} only together"
            detail = f"placing parts moves them apart by up to {span.needed(way):.3g} um, three standard deviations"
            yield error("goal", text, detail=detail, hint=_would(nominal, span, way))
            return


def nominal_of(setup: Setup, state: LabState) -> Nominal:
    """Return the nominal bench that a state describes."""
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    return Nominal(setup, poses, {name: part.values for name, part in state.components.items()})


def span_of(nominal: Nominal, name: str, goal: Goal) -> Span | None:
    """Return what placing parts may do to a goal that is to be reached, and what its tunables do; None where no light
    comes there through all that it tunes (a lens in storage: the goal is one of other states), or the model cannot tell
    its numbers."""
    numbers = tuple(goal.reach or ())
    if not numbers or nominal.numbers(numbers) is None:
        return None
    if not {address.partition(".")[0] for address in goal.tunables} <= set(nominal.on_the_way(numbers)):
        return None
    spread = [sigma * column for column, sigma in _spread(nominal, numbers)]
    tuned = [nominal.by_tunable(numbers, address) for address in goal.tunables]
    if any(column is None for column in tuned):
        return None
    bounds = [_bounds(nominal, address, limits) for address, limits in goal.tunables.items()]
    return Span(
        name, numbers, np.array(spread).reshape(-1, len(numbers)).T, np.array(tuned).T, np.array(bounds)
    )  # fmt: skip


def _spread(nominal: Nominal, numbers: Sequence[str]) -> Iterator[tuple[Array, float]]:
    """Yield how numbers change per mm or deg of each way to put down each part that is put down, with its sigma."""
    for part in nominal.on_the_way(numbers):
        if part not in nominal.setup.lab.inventory or nominal.setup.lab.inventory[part].pose is not None:
            continue
        one = scatter_of(nominal.setup, part)
        for way in PLACED:
            column = nominal.by_placing(numbers, part, way)
            if column is not None:
                yield column, getattr(one, way)


def _bounds(nominal: Nominal, address: str, limits: tuple[float, float]) -> tuple[float, float]:
    """Return how far a tunable may go from where it is."""
    component, _, tunable = address.partition(".")
    here = nominal.values.get(component, {}).get(tunable, 0.0)
    return min(0.0, limits[0] - here), max(0.0, limits[1] - here)


def _both(span: Span, way: Array) -> float:
    """Return the lesser of how far tunables lead along a direction and against it."""
    return min(span.able(way), span.able(-way))


def _directions(count: int) -> Iterator[Array]:
    if count == 2:
        for n in range(DIRECTIONS):
            angle = math.pi * n / DIRECTIONS
            yield np.array([math.cos(angle), math.sin(angle)])
    elif count > 2:
        drawn = np.random.default_rng(1).standard_normal((DIRECTIONS * count, count))
        yield from drawn / np.linalg.norm(drawn, axis=1)[:, None]


def _short(nominal: Nominal, span: Span, goal: Goal, number: str, needed: float, able: float) -> Diagnostic:
    way = np.array([float(n == number) for n in span.numbers])
    most = max(span.able(way), span.able(-way))
    if most < goal.near(number):
        text = f"nothing that {span.goal} tunes moves {number}"
    elif able < goal.near(number):
        text = f"what {span.goal} tunes moves {number} one way only"
    else:
        text = f"what {span.goal} tunes moves {number} by {able:.3g} um only"
    detail = f"placing the parts on the way moves it by up to {needed:.3g} um, three standard deviations"
    return error("goal", text, detail=detail, hint=_would(nominal, span, way))


def _would(nominal: Nominal, span: Span, way: Array) -> str:
    """Return what would make up for what placing parts does along a direction: wider bounds, or what else steers."""
    found = list(_able_alone(nominal, span, way))
    names: Mapping[str, list[str]] = {
        one: [c for c, t in found if t == one] for one in dict.fromkeys(t for _, t in found)
    }
    words = [f"{one} of {' or '.join(parts[:3])}" for one, parts in names.items()]
    return f"{', or '.join(words)} would" if words else "a mirror with tip and tilt, or a lens on a stage, would"


def _able_alone(nominal: Nominal, span: Span, way: Array) -> Iterator[tuple[str, str]]:
    """Yield component and tunable of what a motor steers on the way and leads far enough over its range."""
    for part in nominal.on_the_way(span.numbers):
        kinds = nominal.setup.type_of(part).tunables if part in nominal.setup.lab.inventory else {}
        for tunable in (t for t in _STEERS if t in kinds and kinds[t].range and kinds[t].mover == "motor"):
            column = nominal.by_tunable(span.numbers, f"{part}.{tunable}")
            low, high = _bounds(nominal, f"{part}.{tunable}", kinds[tunable].range or (0.0, 0.0))
            if column is not None and min(-low, high) * abs(float(way @ column)) >= span.needed(way):
                yield part, tunable
