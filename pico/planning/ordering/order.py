"""What must happen before what, and the order in which the arms take their moves."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pico.model.setup import Setup
from pico.planning.ordering.conflicts import Conflicts, Spot, sum_of
from pico.planning.ordering.search import OrderedMove

Closure = tuple[frozenset[int], ...]
"""For each step the indices of all steps that must come before it, directly or not."""


def precedence(table: Conflicts, steps: Sequence[OrderedMove], extra: Mapping[int, int]) -> Closure:
    """Return which of the steps, given in an order that works, must come before which in every order.

    Of two moves the first must stay first where the second needs the spot that it leaves, or takes the spot that it
    needs empty. Every order that keeps all of these works as well: a component that is elsewhere than in the given
    order has skipped, or run ahead by, a move that the pair is ordered for. `extra`: bits that the path of a step
    needs besides its mask.
    """
    touched = sum_of(table.bit(s.mover, place) for s in steps for place in (s.start, s.goal))
    left, needed, own = defaultdict[Spot, int](int), defaultdict[Spot, int](int), defaultdict[int, int](int)
    masks: list[int] = []
    for k, step in enumerate(steps):
        needs = tuple(table.at((step.mask | extra.get(k, 0)) & touched))
        direct = own[step.mover] | needed[step.mover, step.goal] | sum_of(left[spot] for spot in needs)
        masks.append(_closed(direct, masks))
        own[step.mover] |= 1 << k
        left[step.mover, step.start] |= 1 << k
        for spot in needs:
            needed[spot] |= 1 << k
    return tuple(frozenset(e for e in range(k) if mask >> e & 1) for k, mask in enumerate(masks))


def _closed(direct: int, earlier: Sequence[int]) -> int:
    """Return a set of steps with all that must come before them, as bits; the latest say most, so they come first."""
    found = 0
    while direct:
        last = direct.bit_length() - 1
        found |= 1 << last | earlier[last]
        direct &= ~found
    return found


def reduced(closure: Closure) -> tuple[tuple[int, ...], ...]:
    """Return for each step those that come directly before it: what the others do not already say."""
    return tuple(tuple(sorted(before.difference(*(closure[e] for e in before)))) for before in closure)


def arranged(setup: Setup, table: Conflicts, steps: Sequence[OrderedMove], closure: Closure) -> tuple[OrderedMove, ...]:
    """Return the steps in an order that keeps `closure`, each time the one whose pick is nearest to where its robot
    is; a robot goes on as long as it can before another has its turn."""
    at = {name: (r.mount.x, r.mount.y) for name, r in setup.lab.robots.items()}
    left, done, out = list(range(len(steps))), set[int](), []
    turn: str | None = None
    while left:

        def way_to(k: int, turn: str | None = turn) -> tuple[bool, float, int]:
            pose = table.movers[steps[k].mover].places[steps[k].start].pose
            robot = steps[k].hold.robot
            x, y = at.get(robot or "", (pose.x, pose.y))
            return (
                turn is not None and robot is not None and robot != turn,
                round(math.hypot(pose.x - x, pose.y - y), 6),
                k,
            )

        k = min((k for k in left if closure[k] <= done), key=way_to)
        left.remove(k)
        done.add(k)
        out.append(steps[k])
        turn = steps[k].hold.robot or turn
        if steps[k].hold.robot:
            goal = table.movers[steps[k].mover].places[steps[k].goal].pose
            at[steps[k].hold.robot or ""] = (goal.x, goal.y)
    return tuple(out)


@dataclass(frozen=True, slots=True)
class ArmTurn:
    """Consecutive steps of one robot; it parks after them, so that the next robot finds the table free of it."""

    robot: str
    steps: tuple[int, ...]


def turns(steps: Sequence[OrderedMove]) -> tuple[ArmTurn, ...]:
    """Return the turns in which the robots take the steps; those of people belong to none."""
    found: list[ArmTurn] = []
    for k, step in enumerate(steps):
        robot = step.hold.robot
        if robot is None:
            continue
        if found and found[-1].robot == robot:
            found[-1] = ArmTurn(robot, (*found[-1].steps, k))
        else:
            found.append(ArmTurn(robot, (k,)))
    return tuple(found)
