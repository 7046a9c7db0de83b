"""The fewest components to stage if storage had room for all: a bound on every plan, and the skeleton of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.planning.conflicts import Conflicts
from pico.planning.feedback import Arc, Component, Event, Option, Problem, arrives, leaves
from pico.planning.movers import Hold


def relaxation(table: Conflicts, weights: tuple[float, ...] | None = None) -> Problem:
    """Return the problem of staging as few as possible (weighted by what the movers cost to stage, or by `weights`),
    in which a staged component stands in nobody's way.

    A component leaves where it stands when it is first picked, and arrives when it is last put down. Whatever a plan
    does in between, these two keep every order that this problem asks for, so no plan stages less.
    """
    components, common = [], list[Arc]()
    for i, mover in enumerate(table.movers):
        weight = weights[i] if weights else 1.0 + mover.penalty
        own = Component(tuple(_direct(table, i)), tuple(_picks(table, i)), tuple(_places(table, i)), weight)
        shared = _shared(own)
        common += shared
        components.append(_without(own, frozenset(shared)))
    return Problem(tuple(components), tuple(common))


def _direct(table: Conflicts, i: int) -> Iterator[Option]:
    mover = table.movers[i]
    for goal in mover.goals:
        for way in table.ways(i, 0, goal):
            yield Option((goal, way.hold), _arcs(table, arrives(i), way.mask, table.arrive(i, goal) or 0), goal)
    if mover.right:
        yield Option(None, (), 0)  # stays; whatever excludes its place already waits for it to leave


def _picks(table: Conflicts, i: int) -> Iterator[Option]:
    """Yield the holds in which a component can be picked and put down in some slot, be it its own."""
    known: list[int] = []
    for hold in table.movers[i].holds:
        mask = table.grip(i, 0, hold)
        if mask is None or any(m | mask == mask for m in known) or not _storable(table, i, hold):
            continue
        known.append(mask)
        yield Option(hold, _arcs(table, leaves(i), mask, 0))


def _storable(table: Conflicts, i: int, hold: Hold) -> bool:
    mover = table.movers[i]
    between = (*mover.staging, *(mover.goals if len(mover.goals) > 1 else ()))
    return any(table.grip(i, p, hold) is not None and table.arrive(i, p) is not None for p in between)


def _places(table: Conflicts, i: int) -> Iterator[Option]:
    mover = table.movers[i]
    for goal in sorted(mover.finished):
        body = table.arrive(i, goal)
        known: list[int] = []
        for hold in mover.holds if body is not None else ():
            grip = table.grip(i, goal, hold)
            mask = (body or 0) | (grip or 0)
            if grip is None or any(m | mask == mask for m in known) or not _storable(table, i, hold):
                continue
            known.append(mask)
            yield Option((goal, hold), _arcs(table, arrives(i), mask, body or 0), goal)


def _arcs(table: Conflicts, event: Event, mask: int, body: int) -> tuple[Arc, ...]:
    """Return what must come before and after an event that needs the spots of `mask` empty, those of `body` for the
    body's sake. Storage is left out of account."""
    found = []
    for j, place in table.at(mask):
        other = table.movers[j]
        kind = "body" if table.bit(j, place) & body else "fingers"
        if place == 0:
            found.append(Arc(leaves(j), event, kind))
        if place in other.finished:
            goals = ((j, place),) if len(other.finished) > 1 else ()
            found.append(Arc(event, arrives(j), kind, goals))
    return tuple(found)


def _shared(component: Component) -> list[Arc]:
    """Return the arcs that every way to arrive brings."""
    ways = [*component.direct, *(component.place if component.may_be_staged else ())]
    if not ways:
        return []
    inside = frozenset(ways[0].arcs).intersection(*(w.arcs for w in ways[1:]))
    return [arc for arc in ways[0].arcs if arc in inside]


def _without(component: Component, shared: frozenset[Arc]) -> Component:
    def left(options: tuple[Option, ...]) -> tuple[Option, ...]:
        return tuple(replace(o, arcs=tuple(a for a in o.arcs if a not in shared)) for o in options)

    return replace(component, direct=left(component.direct), place=left(component.place))
