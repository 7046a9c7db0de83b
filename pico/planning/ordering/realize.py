"""From the components to stage to an order of moves: leave late, arrive early, and a free slot for each meanwhile."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.search import OrderedMove, ranked_storage
from pico.staging.feedback import Choice, PartEvent, StagingAnswer, StagingProblem

TRIES = 2000
"""Moves tried in all to find slots for one order."""

FEW_STAGED = 10
"""Up to so many staged components all orders are weighed for the fewest in storage at one time."""

Act = tuple[int, str]
"""A mover, and which of its moves: `direct`, `leaves` for storage, or `arrives` from there."""


def realized(table: Conflicts, problem: StagingProblem, answer: StagingAnswer) -> tuple[OrderedMove, ...] | None:
    """Return moves that stage exactly what `answer` stages, or None where no slots for them are found."""
    assert answer.options is not None
    stays = {i for i, c in enumerate(answer.options) if c.direct is not None and _stays(problem, i, c.direct)}
    before = _before(problem, answer.options)
    for ordered in (_order, _roomiest):
        replay = _Replay(table, [act for act in ordered(before) if act[0] not in stays], TRIES)
        if replay.run():
            return tuple(replay.steps)
    return None


def slots_needed(problem: StagingProblem, answer: StagingAnswer) -> int:
    """Return how many components must be in storage at one time where those of `answer` are staged as it says: the
    least number in any order, where they are few."""
    assert answer.options is not None
    return _peak(_roomiest(_before(problem, answer.options)))


def _stays(problem: StagingProblem, i: int, direct: int) -> bool:
    return problem.components[i].direct[direct].name is None


def _act(event: PartEvent, choices: Sequence[Choice]) -> Act:
    i = event.component
    return (i, event.what if choices[i].staged else "direct")


def _before(problem: StagingProblem, choices: Sequence[Choice]) -> dict[Act, set[Act]]:
    """Return for each move those that must come before it."""
    before: dict[Act, set[Act]] = {}
    arcs = list(problem.arcs)
    goals = {}
    for i, (component, choice) in enumerate(zip(problem.components, choices, strict=True)):
        if choice.direct is None:
            assert choice.pick is not None and choice.place is not None
            pick, end = component.pick[choice.pick], component.place[choice.place]
            before |= {(i, "leaves"): set(), (i, "arrives"): {(i, "leaves")}}
            arcs += pick.arcs
        else:
            end = component.direct[choice.direct]
            before[i, "direct"] = set()
        arcs += end.arcs
        goals[i] = end.goal
    for arc in arcs:
        first, then = _act(arc.before, choices), _act(arc.after, choices)
        if first != then and all(goals[j] == goal for j, goal in arc.goals):
            before[then].add(first)
    return before


def _order(before: dict[Act, set[Act]]) -> list[Act]:
    """Return an order in which few components are in storage at a time: nothing leaves for storage while anything can
    arrive, and then what the next arrival needs least of."""
    left, order, gone = dict.fromkeys(sorted(before)), list[Act](), set[Act]()
    while left:
        ready = [a for a in left if before[a] <= gone]
        arriving = [a for a in ready if a[1] != "leaves"]
        chosen = arriving[:1] or _for_the_nearest(before, list(left), gone) or ready[:1]
        for act in chosen:
            del left[act]
            gone.add(act)
            order.append(act)
    return order


def _for_the_nearest(before: dict[Act, set[Act]], left: Sequence[Act], gone: set[Act]) -> list[Act]:
    """Return the moves to storage after which something can arrive: the fewest, and of others first."""
    best: list[Act] = []
    for act in left:
        if act[1] == "leaves":
            continue
        needs, stack = set[Act](), [act]
        while stack:
            for earlier in before[stack.pop()] - gone - needs:
                needs.add(earlier)
                stack.append(earlier)
        if all(a[1] == "leaves" for a in needs) and (not best or len(needs) < len(best)):
            best = _sorted(before, needs)
    return best


def _sorted(before: dict[Act, set[Act]], acts: set[Act]) -> list[Act]:
    out: list[Act] = []
    while len(out) < len(acts):
        out.append(next(a for a in sorted(acts) if a not in out and (before[a] & acts) <= set(out)))
    return out


def _peak(order: Sequence[Act]) -> int:
    now = most = 0
    for _, what in order:
        now += (what == "leaves") - (what == "arrives")
        most = max(most, now)
    return most


def _roomiest(before: dict[Act, set[Act]]) -> list[Act]:
    """Return an order with the fewest in storage at one time: the best over all sets of those that have left, as long
    as these are few."""
    leaving = sorted(a for a in before if a[1] == "leaves")
    if len(leaving) > FEW_STAGED:
        return _order(before)
    best: dict[frozenset[Act], int] = {}
    heap: list[tuple[int, int, int, list[Act]]] = [(0, 0, 0, _arriving(before, []))]
    while heap:
        peak, _, _, order = heapq.heappop(heap)
        done = frozenset(order)
        if len(order) == len(before):
            return order
        if done in best:
            continue
        best[done] = peak
        for n, act in enumerate(leaving):
            if act not in done and before[act] <= done:
                after = _arriving(before, [*order, act])
                heapq.heappush(heap, (max(peak, _peak([*order, act])), len(before) - len(after), n, after))
    return _order(before)


def _arriving(before: dict[Act, set[Act]], order: list[Act]) -> list[Act]:
    """Return an order, prolonged by all that can arrive without anything else leaving."""
    gone = set(order)
    while True:
        ready = [a for a in sorted(before) if a[1] != "leaves" and a not in gone and before[a] <= gone]
        if not ready:
            return order
        order = [*order, *ready]
        gone.update(ready)


@dataclass(slots=True)
class _Replay:
    """Walks an order of moves and chooses slots, back and forth, until `tries` moves were tried."""

    table: Conflicts
    order: Sequence[Act]
    tries: int
    steps: list[OrderedMove] = field(default_factory=list)
    _storage: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def run(self) -> bool:
        """Make the moves; False where no slots for them are found."""
        places, taken = [0] * len(self.table.movers), self.table.starts
        trail: list[Iterator[OrderedMove]] = []
        while len(self.steps) < len(self.order):
            if len(trail) == len(self.steps):
                trail.append(self._ways(self.order[len(trail)], places, taken))
            step = next(trail[-1], None) if self.tries > 0 else None
            if step is not None:
                self.tries -= 1
                self.steps.append(step)
                places[step.mover] = step.goal
                taken ^= self._moved(step)
                continue
            trail.pop()
            if not self.steps or self.tries <= 0:
                return False
            undone = self.steps.pop()
            places[undone.mover] = undone.start
            taken ^= self._moved(undone)
        return True

    def _moved(self, step: OrderedMove) -> int:
        """Return the bits of the spots that a move leaves and takes."""
        return self.table.bit(step.mover, step.start) ^ self.table.bit(step.mover, step.goal)

    def _ways(self, act: Act, places: list[int], taken: int) -> Iterator[OrderedMove]:
        i, what = act
        for goal in self._between(i) if what == "leaves" else self._ends(i, places[i]):
            way = self.table.way(i, places[i], goal, taken)
            if way:
                yield OrderedMove(i, places[i], goal, way.hold, way.mask)

    def _ends(self, i: int, now: int) -> list[int]:
        return sorted(self.table.movers[i].finished - {now})

    def _between(self, i: int) -> tuple[int, ...]:
        """Return the storage from which a component can go on, best first."""
        if i not in self._storage:
            self._storage[i] = tuple(
                p for p in ranked_storage(self.table, i, range(len(self.table.movers)))
                if any(self.table.ways(i, p, g) for g in self.table.movers[i].finished)
            )  # fmt: skip
        return self._storage[i]
