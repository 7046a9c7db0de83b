"""From movers and obstacles to an order of moves with paths: search harder, or move more, only where it must."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.fewest_stagings import COMPLETE, search_fewest, stagings
from pico.planning.ordering.paths import NoPath, Paths, find_paths
from pico.planning.ordering.search import Configuration, OrderedMove
from pico.planning.ordering.shorten import shortened
from pico.planning.ordering.travel import ArmTour, toured
from pico.planning.parts.movers import Mover, Obstacle

PATH_ROUNDS = 200
"""How often the search may start again because a path was blocked; as often again in all where more may be moved."""


@dataclass(slots=True)
class PathRounds:
    """How often the search may still start again, in several attempts."""

    left: int = PATH_ROUNDS


@dataclass(frozen=True, slots=True)
class OrderedMoves:
    """The moves in order, with the tables that they were found in, their paths (None without motion), and a number of
    stagings below which no plan can go that moves the same components. `slots`: how many free slots would do for as few
    as storage with room for all would need, where there are not so many."""

    table: Conflicts
    tour: ArmTour
    paths: Paths | None
    least: int
    slots: int

    @property
    def steps(self) -> tuple[OrderedMove, ...]:
        """The moves in order."""
        return self.tour.steps

    @property
    def staged(self) -> int:
        """How many moves put a component down on its way."""
        return stagings(self.steps)


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why there is no order: movers that can't all reach their goals whatever the others do (`core`, proven), or none
    known; the configuration that came closest; the paths that were blocked on the way. `slots`: how many free slots
    would do, if that is all that lacks. `widest`: why there is none either where most of what is right may be moved.
    `paths_ended`: the search ended because so many paths were blocked."""

    table: Conflicts
    core: tuple[int, ...]
    closest: Configuration
    proven: bool
    blocked: tuple[NoPath, ...] = ()
    slots: int = 0
    widest: Refusal | None = None
    paths_ended: bool = False


@dataclass(slots=True)
class OrderingProblem:
    """One planning problem. `asides`: components that are right but may be moved to make room, as movers; `direct`:
    only moves straight to the goal, of nobody else. `on_table`: parts may be put down in staging regions, too;
    `every_slot`: in any slot that is free, not only in the nearest of many. `fastest`: of several answers take that
    which takes least time, though it stage more."""

    setup: Setup
    seen: Observation
    movers: tuple[Mover, ...]
    obstacles: tuple[Obstacle, ...]
    asides: tuple[Mover, ...]
    motion: Motion | None
    on_table: bool = False
    fastest: bool = False
    every_slot: bool = False

    def widened(self, names: frozenset[str]) -> OrderingProblem:
        """Return the problem in which these components may be moved aside."""
        movers = (*self.movers, *(m for m in self.asides if m.name in names))
        rest = tuple(o for o in self.obstacles if o.name not in names)
        return replace(self, movers=movers, obstacles=rest, asides=())


def solve(problem: OrderingProblem) -> OrderedMoves | Refusal:
    """Return an order of moves, or why there is none. All slots are looked at only where the nearest do not suffice,
    parts are put down on the free table only where slots do not, and what is right is moved only where there is no
    other way."""
    first, rounds = attempt(problem, PathRounds()), PathRounds()
    if isinstance(first, Refusal) and first.table.more_slots:
        problem = replace(problem, every_slot=True)
        first = attempt(problem, rounds)
    if isinstance(first, OrderedMoves):
        return first
    if any(region.staging for region in problem.setup.lab.regions.values()):
        problem = replace(problem, on_table=True)
        second = attempt(problem, rounds)
        if isinstance(second, OrderedMoves):
            return second
    widest: Refusal | None = None
    for names in _asides(problem, first):
        answer = attempt(problem.widened(names), rounds)
        if isinstance(answer, OrderedMoves):
            return answer
        widest = answer
    return replace(first, widest=widest)


def attempt(problem: OrderingProblem, rounds: PathRounds) -> OrderedMoves | Refusal:
    """Return an order for exactly these movers, every path of it checked, or why there is none."""
    table = Conflicts(
        problem.setup, problem.movers, problem.obstacles, problem.motion, problem.on_table, problem.every_slot
    )
    blocked: list[NoPath] = []
    start: Configuration = (0,) * len(table.movers)
    while True:
        found = search_fewest(table, several=problem.fastest)
        if found.steps is None:
            proven = found.proven and not table.more_slots
            return Refusal(table, found.core, found.closest, proven, tuple(blocked), found.slots)
        answers = dict.fromkeys(shortened(table, steps) for steps in (found.steps, *found.others))
        tours = (toured(table, steps, problem.seen, problem.motion) for steps in answers)
        tour = min(tours, key=lambda t: (round(t.seconds, 3), len(t.steps)))
        if problem.motion is None:
            return OrderedMoves(table, tour, None, found.least, found.slots)
        paths = find_paths(table, tour.steps, problem.seen, problem.motion)
        if isinstance(paths, Paths):
            return OrderedMoves(table, tour, paths, found.least, found.slots)
        blocked.append(paths)
        rounds.left -= 1
        if rounds.left < 0:
            return Refusal(table, (), found.closest or start, False, tuple(blocked), paths_ended=True)
        if _by_itself(table, paths):
            table.forbid_hold(paths.step.mover, paths.step.hold)
        else:
            table.forbid(paths.step.mover, paths.step.start, paths.step.goal, paths.step.hold, paths.spot)


def _by_itself(table: Conflicts, no: NoPath) -> bool:
    """Whether a part is in the way of the fingers that should hold it, which it is wherever it stands."""
    own = no.blocked.obstacle == table.movers[no.step.mover].name
    return own and no.blocked.segment not in ("approach", "transit", "park")


def _asides(problem: OrderingProblem, refused: Refusal) -> Iterator[frozenset[str]]:
    """Yield growing sets of components that might make room: those that hinder a mover, those that hinder these, and
    for a small table all of them."""
    by_name = {m.name: m for m in problem.asides}
    ring: frozenset[str] = frozenset()
    front: list[Mover] = list(problem.movers)
    everything = frozenset(by_name) if len(problem.movers) + len(by_name) <= COMPLETE else frozenset()
    for _ in range(3):
        names = ring | {n for m in front for n in _near(refused.table, m) if n in by_name}
        if names == ring:
            break
        front, ring = [by_name[n] for n in sorted(names - ring)], frozenset(names)
        yield ring
    if everything and everything != ring:
        yield everything


def _near(table: Conflicts, mover: Mover) -> Iterator[str]:
    """Yield the obstacles that fingers or body of a mover may meet where it starts or should end."""
    lab = table.setup.lab
    reach = max(_finger_reach(table, mover), mover.geometry.footprint.radius) + max(
        lab.margins.body, lab.margins.fingers
    )
    for place in (0, *mover.goals):
        pose = mover.places[place].pose
        for name, o in table.obstacles.items():
            if pose.distance(o.standing.pose) <= reach + o.shape.radius:
                yield name


def _finger_reach(table: Conflicts, mover: Mover) -> float:
    grasp = mover.geometry.grasp
    if grasp is None:
        return 0.0
    reaches = [0.0]
    for robot in table.setup.lab.robots.values():
        fingers = robot.gripper.fingers
        if fingers != "none":
            reaches.append(grasp.width / 2 + fingers.opening + fingers.thickness + fingers.breadth / 2)
    return max(reaches)
