"""Asks the arms for the path of every move, in the world of its step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from pico.model.observation import Observation
from pico.motion.types import Blocked, Joints, Motion, MovePath, StandingObject
from pico.motion.zones import MARGIN, enters, shared_zones, within
from pico.planning.ordering.conflicts import Conflicts, Spot
from pico.planning.ordering.order import precedence
from pico.planning.ordering.search import OrderedMove


@dataclass(frozen=True, slots=True)
class Park:
    """An arm goes to its park pose after these of its steps: before step `before` of another arm, or (None) at the
    end. `path`: None without motion."""

    robot: str
    steps: tuple[int, ...]
    before: int | None
    path: MovePath | Blocked | None = None


@dataclass(frozen=True, slots=True)
class Paths:
    """The path of each step (None for a person's), the parks in order, and the bits that paths need empty besides the
    masks, by step."""

    moves: tuple[MovePath | None, ...]
    parks: tuple[Park, ...]
    extra: Mapping[int, int]


@dataclass(frozen=True, slots=True)
class NoPath:
    """A step without a path, or after which its arm can't park: what blocks it, and the spot of the component that
    does, if it is one that moves."""

    step: OrderedMove
    blocked: Blocked
    spot: Spot | None


def find_paths(table: Conflicts, steps: Sequence[OrderedMove], seen: Observation, motion: Motion) -> Paths | NoPath:
    """Return the paths of `steps` one after the other, or the first step that has none.

    A path is asked for among everything that may stand there at that step in any order that keeps the precedence, so
    that it holds in each of them; where only another order would be in the way, the order is fixed by `extra`. An arm
    that stands where another must come in parks first, and so do arms that were left standing where arms meet.
    """
    worlds = Worlds(table, steps)
    moves: list[MovePath | None] = [None] * len(steps)
    arms = Arms(table, steps, seen, motion)
    for k, step in enumerate(steps):
        robot = step.hold.robot
        if robot is None:
            continue
        path = _path(worlds, k, arms.joints.get(robot), motion)
        if isinstance(path, NoPath):
            return path
        arms.make_way(k, path)
        arms.moved(k, path)
        moves[k] = path
    arms.park_all()
    if arms.stuck is not None:
        return arms.stuck
    return Paths(tuple(moves), tuple(arms.parks), worlds.extra)


class Worlds:
    """What may stand on the table while each of the steps runs. `extra`: bits that the path of a step needs empty
    besides its mask."""

    def __init__(self, table: Conflicts, steps: Sequence[OrderedMove]) -> None:
        self.table, self.steps = table, steps
        self.extra: dict[int, int] = {}
        self.staying = {name: o.standing for name, o in table.obstacles.items()}
        self._standing: dict[Spot, StandingObject] = {}
        self._closure = precedence(table, steps, self.extra)
        self._chains: list[list[int]] = [[] for _ in table.movers]
        for e, step in enumerate(steps):
            self._chains[step.mover].append(e)

    def keep_empty(self, k: int, spot: Spot) -> None:
        """Have a spot empty while step `k` runs."""
        self.extra[k] = self.extra.get(k, 0) | self.table.bit(*spot)
        self._closure = precedence(self.table, self.steps, self.extra)

    def possible(self, k: int) -> Iterator[Spot]:
        """Yield the spots of other movers that may be taken while step `k` runs, in some order that keeps what must
        come before what."""
        for j, chain in enumerate(self._chains):
            if j == self.steps[k].mover:
                continue
            place = 0
            for e in chain:
                if e not in self._closure[k]:
                    yield j, place
                if k in self._closure[e]:
                    break
                place = self.steps[e].goal
            else:
                yield j, place

    def standing(self, spot: Spot) -> StandingObject:
        """Return the component of a spot, standing there."""
        if spot not in self._standing:
            self._standing[spot] = _standing(self.table, spot)
        return self._standing[spot]


class Arms:
    """Where the arms stand while paths are found, and the parks that this takes."""

    def __init__(self, table: Conflicts, steps: Sequence[OrderedMove], seen: Observation, motion: Motion) -> None:
        self.parks: list[Park] = []
        self.stuck: NoPath | None = None
        """The first step after which an arm can't park, or for which one that was found standing there can't; where it
        is in nobody's way, it may stay there."""
        self.joints: dict[str, Joints | None] = {name: robot.joints for name, robot in seen.robots.items()}
        self._table, self._steps, self._motion = table, steps, motion
        self._zones = shared_zones(table.setup)
        self._full = {name for name, robot in seen.robots.items() if robot.holding}
        self._since: dict[str, list[int]] = {name: [] for name in sorted(self.joints) if self._astray(name)}

    def _astray(self, robot: str) -> bool:
        """Whether an arm was left where arms meet, its hand empty, and not at its park pose."""
        joints, arm = self.joints[robot], self._table.setup.lab.robots.get(robot)
        if not joints or arm is None or arm.model != "xarm7" or robot in self._full:
            return False
        zones = (z for z in self._zones if robot in z.robots)
        astray = not arm.is_parked(joints)
        return astray and any(within(self._table.setup, z, robot, joints, margin=MARGIN) for z in zones)

    def moved(self, k: int, path: MovePath) -> None:
        """Take step `k` for done."""
        self.joints[path.robot] = path.end
        self._since.setdefault(path.robot, []).append(k)

    def make_way(self, k: int, path: MovePath) -> None:
        """Park the other arms that stand in a zone which the path of step `k` comes into."""
        for zone in self._zones:
            for robot in zone.robots:
                if robot != path.robot and robot in self._since and path.robot in zone.robots:
                    stands = within(self._table.setup, zone, robot, self.joints[robot] or (), margin=MARGIN)
                    if stands and enters(self._table.setup, zone, path, MARGIN):
                        self._park(robot, k)

    def park_all(self) -> None:
        """Park every arm that has moved, in the order of their last steps."""
        for robot in sorted(self._since, key=lambda r: max(self._since[r], default=-1)):
            self._park(robot, None)

    def _park(self, robot: str, before: int | None) -> None:
        steps = tuple(self._since.pop(robot))
        done = self._steps[: max(steps, default=-1) + 1 if before is None else before]
        path = _park(self._table, done, robot, self.joints, self._motion)
        self.parks.append(Park(robot, steps, before, path))
        if isinstance(path, MovePath):
            self.joints[robot] = path.end
        elif path is not None and self.stuck is None and (steps or before is not None):
            step = self._steps[max(steps) if steps else before or 0]
            self.stuck = self._left_behind(step, path if steps else _in_the_way(robot, path), done)

    def _left_behind(self, step: OrderedMove, blocked: Blocked, done: Sequence[OrderedMove]) -> NoPath:
        movers, places = self._table.movers, places_before(self._table, done, len(done))
        spots = [(j, p) for j, p in enumerate(places) if movers[j].name == blocked.obstacle and j != step.mover]
        return NoPath(step, blocked, spots[0] if spots else None)


def _in_the_way(robot: str, park: Blocked) -> Blocked:
    """Why another arm can't come where one was found standing that has no way out."""
    text = f"{robot} was stopped where it would have to pass, and can't park, as {park.text}"
    return replace(park, text=text, segment=None)


def _path(worlds: Worlds, k: int, joints: Joints | None, motion: Motion) -> MovePath | NoPath:
    table, step = worlds.table, worlds.steps[k]
    mover = table.movers[step.mover]
    now = places_before(table, worlds.steps, k)
    start, goal = mover.places[step.start].pose, mover.places[step.goal].pose
    while True:
        ghosts = {_name(table, spot, now): spot for spot in worlds.possible(k)}
        standing = worlds.staying | {name: worlds.standing(spot) for name, spot in ghosts.items()}
        found = motion.move(step.hold.robot or "", mover.name, start, goal, step.hold.yaw, standing, joints)
        if isinstance(found, MovePath):
            return found
        spot = ghosts.get(found.obstacle or "")
        if spot is None or now[spot[0]] == spot[1]:
            return NoPath(step, found, spot)
        worlds.keep_empty(k, spot)


def places_before(table: Conflicts, steps: Sequence[OrderedMove], k: int) -> list[int]:
    """Return where each mover is just before step `k`."""
    places = [0] * len(table.movers)
    for step in steps[:k]:
        places[step.mover] = step.goal
    return places


def _name(table: Conflicts, spot: Spot, now: Sequence[int]) -> str:
    name = table.movers[spot[0]].name
    return name if now[spot[0]] == spot[1] else f"{name}@{spot[1]}"


def _standing(table: Conflicts, spot: Spot) -> StandingObject:
    mover = table.movers[spot[0]]
    return StandingObject(mover.places[spot[1]].pose, mover.geometry)


def _park(
    table: Conflicts, done: Sequence[OrderedMove], robot: str, joints: Mapping[str, Joints | None], motion: Motion
) -> MovePath | Blocked:
    places = places_before(table, done, len(done))
    standing = {name: o.standing for name, o in table.obstacles.items()} | {
        m.name: _standing(table, (j, places[j])) for j, m in enumerate(table.movers)
    }
    now, others = joints.get(robot) or (), {name: q for name, q in joints.items() if q and name != robot}
    return motion.park(robot, now, standing, others) if others else motion.park(robot, now, standing)
