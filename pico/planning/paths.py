"""Asks the arms for the path of every move, in the world of its step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pico.model.observation import Observation
from pico.motion.types import Blocked, Joints, Motion, MovePath, Standing
from pico.planning.conflicts import Conflicts, Spot
from pico.planning.order import Closure, precedence, turns
from pico.planning.search import Step


@dataclass(frozen=True, slots=True)
class Paths:
    """The path of each step (None for a person's), the park after each turn, and the bits that paths need empty
    besides the masks, by step."""

    moves: tuple[MovePath | None, ...]
    parks: tuple[MovePath | Blocked, ...]
    extra: Mapping[int, int]


@dataclass(frozen=True, slots=True)
class NoPath:
    """A step without a path: what blocks it, and the spot of the component that does, if it is one that moves."""

    step: Step
    blocked: Blocked
    spot: Spot | None


def find_paths(table: Conflicts, steps: Sequence[Step], seen: Observation, motion: Motion) -> Paths | NoPath:
    """Return the paths of `steps` one after the other, or the first step that has none.

    A path is asked for among everything that may stand there at that step in any order that keeps the precedence, so
    that it holds in each of them; where only another order would be in the way, the order is fixed by `extra`.
    """
    extra: dict[int, int] = {}
    joints: dict[str, Joints | None] = {name: robot.joints for name, robot in seen.robots.items()}
    moves: list[MovePath | None] = [None] * len(steps)
    parks: list[MovePath | Blocked] = []
    for turn in turns(steps):
        for k in turn.steps:
            path = _path(table, steps, k, extra, joints.get(turn.robot), motion)
            if isinstance(path, NoPath):
                return path
            joints[turn.robot] = path.end
            moves[k] = path
        parks.append(_park(table, steps[: turn.steps[-1] + 1], turn.robot, joints[turn.robot] or (), motion))
        end = parks[-1]
        joints[turn.robot] = end.end if isinstance(end, MovePath) else joints[turn.robot]
    return Paths(tuple(moves), tuple(parks), extra)


def _path(
    table: Conflicts, steps: Sequence[Step], k: int, extra: dict[int, int], joints: Joints | None, motion: Motion
) -> MovePath | NoPath:
    step = steps[k]
    mover = table.movers[step.mover]
    now = places_before(table, steps, k)
    while True:
        closure = precedence(table, steps, extra)
        ghosts = {_name(table, spot, now): spot for spot in possible(table, steps, closure, k)}
        standing = {name: o.standing for name, o in table.obstacles.items()} | {
            name: _standing(table, spot) for name, spot in ghosts.items()
        }
        start, goal = mover.places[step.start].pose, mover.places[step.goal].pose
        found = motion.move(step.hold.robot or "", mover.name, start, goal, step.hold.yaw, standing, joints)
        if isinstance(found, MovePath):
            return found
        spot = ghosts.get(found.obstacle or "")
        if spot is None or now[spot[0]] == spot[1]:
            return NoPath(step, found, spot)
        extra[k] = extra.get(k, 0) | table.bit(*spot)


def places_before(table: Conflicts, steps: Sequence[Step], k: int) -> list[int]:
    """Return where each mover is just before step `k`."""
    places = [0] * len(table.movers)
    for step in steps[:k]:
        places[step.mover] = step.goal
    return places


def possible(table: Conflicts, steps: Sequence[Step], closure: Closure, k: int) -> list[Spot]:
    """Return the spots of other movers that may be taken while step `k` runs, in some order that keeps `closure`."""
    spots: list[Spot] = []
    for j in range(len(table.movers)):
        if j == steps[k].mover:
            continue
        chain = [e for e, s in enumerate(steps) if s.mover == j]
        stops = [(None, 0), *((e, steps[e].goal) for e in chain)]
        for n, (arrival, place) in enumerate(stops):
            leaving = chain[n] if n < len(chain) else None
            gone = leaving is not None and leaving in closure[k]
            later = arrival is not None and k in closure[arrival]
            if not gone and not later:
                spots.append((j, place))
    return spots


def _name(table: Conflicts, spot: Spot, now: Sequence[int]) -> str:
    name = table.movers[spot[0]].name
    return name if now[spot[0]] == spot[1] else f"{name}@{spot[1]}"


def _standing(table: Conflicts, spot: Spot) -> Standing:
    mover = table.movers[spot[0]]
    return Standing(mover.places[spot[1]].pose, mover.geometry)


def _park(table: Conflicts, done: Sequence[Step], robot: str, joints: Joints, motion: Motion) -> MovePath | Blocked:
    places = places_before(table, done, len(done))
    standing = {name: o.standing for name, o in table.obstacles.items()} | {
        m.name: _standing(table, (j, places[j])) for j, m in enumerate(table.movers)
    }
    return motion.park(robot, joints, standing)
