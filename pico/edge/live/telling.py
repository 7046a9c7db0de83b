"""What who draws a bench is told, from one moment to the next: pure.

First `{"scene"}`, the whole of it. Then `{"moved": {"time", "arms", "bodies"}}` with what is elsewhere than it was
told, and, in order, `{"told": kind, "rev", "data"}` for what changes beyond that: a `component`, the `beams`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from pico.drawing.scene import scene as scenes
from pico.model.setup import Setup
from pico.twin.moment import Moment
from pico.twin.placement import Placement

Document = dict[str, Any]
ARM, BODY = 1e-5, 1e-7
"""Joints [rad] and places [m, and of a quaternion] that differ by less are the same."""


@dataclass(frozen=True)
class Told:
    """What was told of a bench: names by index, arms, places and how components stand as they were told last, and on
    what the light depended that was told."""

    setup: Setup
    epoch: int
    rev: int
    names: tuple[str, ...]
    arms: Mapping[int, list[Any]]
    places: Mapping[int, list[float]]
    stood: Mapping[str, Any]
    lit: Any


def begun(setup: Setup, moment: Moment, epoch: int) -> tuple[Told, Document]:
    """Return what is told first, as of an `epoch`."""
    names = scenes.numbered(setup, moment)
    told = Told(
        setup, epoch, 0, names, arms_of(setup, moment), places_of(names, moment), _stood(moment),
        scenes.lighted(setup, moment),
    )  # fmt: skip
    return told, {"scene": {**scenes.scene(setup, moment, names), "epoch": epoch, "rev": 0}}


def moved(told: Told, moment: Moment) -> tuple[Told, Document]:
    """Return what is elsewhere than it was told: an arm as `[index, joints, width]`, a body as `[index, x, y, z, w, i,
    j, k]` [mm]."""
    arms, places = arms_of(told.setup, moment), places_of(told.names, moment)
    turned = {n: arm for n, arm in arms.items() if _differs(told.arms.get(n), arm, ARM)}
    shifted = {n: at for n, at in places.items() if _differs(told.places.get(n), at, BODY)}
    said = posed(moment.seen.time, turned, shifted)
    return replace(told, arms={**told.arms, **turned}, places={**told.places, **shifted}), {"moved": said}


def posed(time: float, arms: Mapping[int, list[Any]], places: Mapping[int, list[float]]) -> Document:
    """Return where arms and bodies are at a time [s], as it is told."""
    return {
        "time": time,
        "arms": [[n, [round(q, 6) for q in arm[:-1]], round(arm[-1], 3)] for n, arm in arms.items()],
        "bodies": [[n, *(round(1000 * v, 4) for v in at[:3]), *(round(v, 7) for v in at[3:])]
                   for n, at in places.items()],
    }  # fmt: skip


def stood(told: Told, moment: Moment) -> tuple[Told, list[Document]]:
    """Return how components stand that stand otherwise than was told; a stranger with what it is."""
    names, now, rev = scenes.numbered(told.setup, moment, told.names), _stood(moment), told.rev
    found = []
    for index, name in enumerate(names):
        if now.get(name) != told.stood.get(name) or index >= len(told.names):
            tell = scenes.component if name not in told.setup.lab.inventory else scenes.now
            rev += 1
            found.append({"told": "component", "rev": rev, "data": tell(told.setup, name, index, moment)})
    return replace(told, names=names, stood=now, rev=rev), found


def relit(told: Told, moment: Moment) -> tuple[Told, list[Document]]:
    """Return the light where it may be another one than was told."""
    lit = scenes.lighted(told.setup, moment)
    if lit == told.lit:
        return told, []
    rev = told.rev + 1
    data = {"beams": scenes.beams(told.setup, moment)}
    return replace(told, lit=lit, rev=rev), [{"told": "beams", "rev": rev, "data": data}]


def drawn_alike(one: Setup, other: Setup) -> bool:
    """Return whether a bench looks the same as another, whatever its arms are allowed."""
    return one is other or one.at_speed(1.0) == other.at_speed(1.0)


def arms_of(setup: Setup, moment: Moment) -> dict[int, list[Any]]:
    """Return joints and width of the arms that are known, by index."""
    return {
        number: [*moment.seen.robots[name].joints, scenes.width(setup, name, moment)]
        for number, name in enumerate(sorted(setup.lab.robots))
        if name in moment.seen.robots and moment.seen.robots[name].joints
    }


def places_of(names: tuple[str, ...], moment: Moment) -> dict[int, list[float]]:
    """Return where bodies are [m] and how they are turned, by index."""
    return {n: _numbers(moment.places[name]) for n, name in enumerate(names) if name in moment.places}


def _numbers(place: Placement) -> list[float]:
    return [*place.position, *place.quaternion]


def _stood(moment: Moment) -> dict[str, Any]:
    known = {name: (seen.presence, seen.how, dict(seen.values)) for name, seen in moment.seen.components.items()}
    return {**known, **dict(moment.seen.unknown)}


def _differs(before: list[Any] | None, after: list[Any], by: float) -> bool:
    return (
        before is None or len(before) != len(after) or any(abs(a - b) > by for a, b in zip(before, after, strict=True))
    )
