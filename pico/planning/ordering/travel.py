"""In which order an arm takes its moves: the least time of its empty hand, and how much less no order can take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from pico.model.observation import Observation
from pico.motion.types import Motion
from pico.planning.ordering.arm_times import least, timed
from pico.planning.ordering.clock import Clock
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.order import Closure, arranged, precedence
from pico.planning.ordering.search import OrderedMove
from pico.planning.ordering.several_arms import handed, shared_out, work_of
from pico.planning.ordering.shorten import valid
from pico.staging.sequencing import Effort, best_order, tightened

CLOSE = 8
"""How many other places to stage a component are weighed."""
MANY = Effort(moves=150_000, steps=20_000_000, rounds=3, pivots=10_000)
"""How hard to look for an order of more moves than are solved exactly at once, and for a bound."""
ROUGH, FINE = replace(MANY, sweeps=0, rounds=0), replace(MANY, moves=0, rounds=0)
"""The same in two steps, without a bound: an order by which stagings find their places, and that one improved."""

Tables = tuple[list[float], list[list[float]], list[float], Closure]
"""What the ways to the first move, between moves and to the park take [s], and what must come before each move."""
Ways = dict[tuple[int, int, float], dict[tuple[int, int, float], float]]
"""What the ways of one arm take [s], from where it places to where it picks: mover, place, and yaw of the hold."""


@dataclass(frozen=True, slots=True)
class ArmTour:
    """Steps in order, how long they take about [s], and the least time in which the arms can take them in any order
    [s]; None where no arm told."""

    steps: tuple[OrderedMove, ...]
    seconds: float
    bound: float | None = None


def toured(table: Conflicts, steps: Sequence[OrderedMove], seen: Observation, motion: Motion | None) -> ArmTour:
    """Return the steps in the order that takes least time, as far as it is found, staged where that is near. Several
    arms work at the same time. Where people take turns with them, or nobody tells how long an arm takes, each goes on
    as long as it can, to the nearest."""
    clock = Clock(table, seen, motion)
    robots = {s.hold.robot for s in steps}
    several = None not in robots and len(table.setup.lab.robots) > 1 and clock.told
    if several:
        steps = shared_out(clock, arranged(table.setup, table, steps, precedence(table, steps, {})))
        robots = {s.hold.robot for s in steps}
    if several and len(robots) > 1:
        return ArmTour(tuple(steps), timed(work_of(clock, steps), range(len(steps)))[0], _least(clock, steps))
    if len(robots) > 1 or None in robots or not steps:
        order = arranged(table.setup, table, steps, precedence(table, steps, {}))
        loaded = {r: sum(clock.loaded(s) for s in order if s.hold.robot == r) for r in robots}
        return ArmTour(order, sum(loaded.values()), max(loaded.values(), default=0.0) if clock.told else None)
    return _one_arm(clock, steps, several)


def _one_arm(clock: Clock, steps: Sequence[OrderedMove], several: bool) -> ArmTour:
    """Return the steps of one arm in order. The bound is that of the order taken; `several`: of all arms that could."""
    ways: Ways = {}
    asked = _tables(clock, steps, ways)
    best = best_order(*asked, limit=ROUGH)
    rough = tuple(steps[k] for k in best.order)
    if (order := nearer(clock, rough)) != rough or not best.proven:
        asked = _tables(clock, order, ways)
        best = best_order(*asked, limit=FINE, first=range(len(order)))
        order = tuple(order[k] for k in best.order)
    loaded = sum(clock.loaded(s) for s in order)
    if several or not clock.told:
        return ArmTour(order, loaded + best.cost, _least(clock, order) if several else None)
    return ArmTour(order, loaded + best.cost, loaded + tightened(*asked, best, MANY).lower_bound)


def _tables(clock: Clock, steps: Sequence[OrderedMove], ways: Ways) -> Tables:
    """Return what is to be ordered; the ways that it takes between moves are added to `ways`, and taken from there."""
    begins = [(s.mover, s.start, s.hold.yaw) for s in steps]
    between = []
    for a in steps:
        known = ways.setdefault((a.mover, a.goal, a.hold.yaw), {})
        for b, begin in zip(steps, begins, strict=True):
            if a is not b and begin not in known:
                known[begin] = clock.between(a, b)
        between.append([known.get(begin, 0.0) for begin in begins])
    start, end = [clock.start(s) for s in steps], [clock.end(s) for s in steps]
    return start, between, end, precedence(clock.table, steps, {})


def _least(clock: Clock, steps: Sequence[OrderedMove]) -> float:
    """Return a time before which several arms can't be done, whichever of them makes each move, in any order [s]."""
    work = work_of(clock, steps)
    free = {
        k: min(clock.loaded(s) for s in (step, *others))
        for k, step in enumerate(steps) if (others := tuple(handed(clock, step)))
    }  # fmt: skip
    tours = []
    for own in ([k for k in work.of(arm) if k not in free] for arm in range(work.arms)):
        between = [[min(work.between[i][j], work.end[i] + work.again[j]) for j in own] for i in own]
        start, end = [min(work.start[k], work.again[k]) for k in own], [work.end[k] for k in own]
        before = [{n for n, e in enumerate(own) if e in work.before[k]} for k in own]
        travel = best_order(start, between, end, before, limit=MANY).lower_bound if own else 0.0
        tours.append(travel + sum(work.loaded[k] for k in own))
    return least(work, tours, free)


def nearer(clock: Clock, steps: tuple[OrderedMove, ...]) -> tuple[OrderedMove, ...]:
    """Return the steps with each staging where it costs the arm least; the others and the order stay."""
    for k, step in enumerate(steps):
        back = next((n for n, other in enumerate(steps) if n > k and other.mover == step.mover), None)
        if back is None or step.goal not in clock.table.movers[step.mover].staging:
            continue
        best = clock.around(steps, k) + clock.around(steps, back)
        for place in _close(clock.table, step, steps[back]):
            changed = list(steps)
            changed[k], changed[back] = replace(step, goal=place), replace(steps[back], start=place)
            tried = valid(clock.table, changed)
            if tried and (cost := clock.around(tried, k) + clock.around(tried, back)) < best - 1e-6:
                best, steps = cost, tried
    return steps


def _close(table: Conflicts, there: OrderedMove, back: OrderedMove) -> list[int]:
    """Return the storage places of a component that lie least off its way."""
    places = table.movers[there.mover].places
    a, b = places[there.start].pose, places[back.goal].pose
    detours = {p: places[p].pose.distance(a) + places[p].pose.distance(b) for p in table.movers[there.mover].staging}
    return sorted((p for p in detours if p != there.goal), key=lambda p: (round(detours[p], 6), p))[:CLOSE]
