"""The fewest components to stage if storage had room for all: a bound on every plan, and the skeleton of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.planning.ordering.conflicts import Conflicts
from pico.planning.parts.movers import Hold, Mover
from pico.staging.feedback import Arc, Component, Option, PartEvent, StagingProblem, arrives, leaves


def relaxation(table: Conflicts, weights: tuple[float, ...] | None = None) -> StagingProblem:
    """Return the problem of staging as few as possible (weighted by what the movers cost to stage, or by `weights`),
    in which a staged component stands in nobody's way, though somebody may stand in its own.

    A component leaves where it stands when it is first picked, and arrives when it is last put down. Whatever a plan
    does in between, these two keep every order that this problem asks for, so no plan stages less.
    """
    components, common = [], list[Arc]()
    for i, mover in enumerate(table.movers):
        weight = weights[i] if weights else staging_cost(mover)
        own = Component(tuple(_direct(table, i)), tuple(_picks(table, i)), tuple(_places(table, i)), weight)
        shared = _shared(own)
        common += shared
        components.append(_without(own, frozenset(shared)))
    return StagingProblem(tuple(components), tuple(common))


def staging_cost(mover: Mover) -> float:
    """Return what it costs to stage a component, in moves: one more than going straight to the goal; there and back,
    where it could stay."""
    return 1.0 + mover.penalty + mover.right


def _direct(table: Conflicts, i: int) -> Iterator[Option]:
    mover = table.movers[i]
    if mover.right:
        yield Option(None, (), 0)  # stays; whatever excludes its place already waits for it to leave
    for goal in mover.goals:
        if mover.right and mover.places[goal].pose == mover.start.pose:
            continue
        for way in table.ways(i, 0, goal):
            yield Option((goal, way.hold), _arcs(table, arrives(i), way.mask, table.arrive(i, goal) or 0), goal)


def _picks(table: Conflicts, i: int) -> Iterator[Option]:
    """Yield the ways to pick a component and put it down in some slot, be it its own."""
    found: list[tuple[int, Hold]] = []
    for hold in table.movers[i].holds:
        mask = table.grip(i, 0, hold)
        if mask is not None:
            found += [(m, hold) for m in _least(mask & table.ends, _meanwhile(table, i, hold, body=True), table.ends)]
    for mask, hold in _undominated(found):
        yield Option(hold, _arcs(table, leaves(i), mask, 0))


def _places(table: Conflicts, i: int) -> Iterator[Option]:
    """Yield the ways to pick a component in some slot and put it down where it belongs."""
    mover = table.movers[i]
    for goal in sorted(mover.finished):
        body = table.arrive(i, goal)
        found: list[tuple[int, Hold]] = []
        for hold in mover.holds:
            grip = table.grip(i, goal, hold)
            if grip is not None and body is not None:
                found += [(m, hold) for m in _least((body | grip) & table.ends, _meanwhile(table, i, hold), table.ends)]
        for mask, hold in _undominated(found):
            yield Option((goal, hold), _arcs(table, arrives(i), mask, body or 0), goal)


def _meanwhile(table: Conflicts, i: int, hold: Hold, *, body: bool = False) -> Iterator[int]:
    """Yield for each place where a component may stand in between what must be empty for the fingers
    there, and (`body`) for itself."""
    mover = table.movers[i]
    if mover.stages and table.more_slots:
        yield 0  # nobody looked at all of them
    for place in (*mover.staging, *(mover.goals if len(mover.goals) > 1 else ())):
        arrival = table.arrive(i, place)
        grip = None if arrival is None else table.grip(i, place, hold)
        if arrival is not None and grip is not None:
            yield (arrival if body else 0) | grip


def _least(mask: int, more: Iterator[int], ends: int) -> list[int]:
    """Return a mask with what each of `more` adds to it: as it is where one adds nothing."""
    found: list[int] = []
    for extra in more:
        if not extra & ends & ~mask:
            return [mask]
        found.append(mask | extra & ends)
    return found


def _undominated(options: list[tuple[int, Hold]]) -> list[tuple[int, Hold]]:
    """Return the options without those that need all that another needs."""
    kept: list[tuple[int, Hold]] = []
    for mask, hold in sorted(options, key=lambda o: o[0].bit_count()):
        if not any(m | mask == mask for m, _ in kept):
            kept.append((mask, hold))
    return kept


def _arcs(table: Conflicts, event: PartEvent, mask: int, body: int) -> tuple[Arc, ...]:
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
