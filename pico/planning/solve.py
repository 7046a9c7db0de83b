"""From movers and obstacles to an order of moves with paths: search harder, or move more, only where it must."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.motion.types import Motion
from pico.planning.conflicts import FEW, Conflicts, sum_of
from pico.planning.movers import Mover, Obstacle
from pico.planning.order import arranged, precedence
from pico.planning.paths import NoPath, Paths, find_paths
from pico.planning.search import Configuration, Effort, Found, Step, search
from pico.planning.shorten import shortened

COMPLETE = FEW
"""Up to so many movers nothing solvable is refused: the last search prunes nothing."""

EFFORTS = (
    Effort(weight=1.0, limit=300, commit=True, slots=3),
    Effort(weight=2.0, limit=600, commit=True, slots=3),
    Effort(weight=3.0, limit=1500, slots=6),
)
EVERYTHING = Effort(weight=2.0, limit=200_000, everyone=True)
PROOF = Effort(weight=2.0, limit=3000, everyone=True)
PROOF_WORK = 30_000
"""Expansions spent in all on proving that a few movers are enough to make a problem impossible."""
PATH_ROUNDS = 200
"""How often the search may start again because a path was blocked."""


@dataclass(frozen=True, slots=True)
class Solution:
    """The moves in order, with the tables that they were found in and their paths (None without motion)."""

    table: Conflicts
    steps: tuple[Step, ...]
    paths: Paths | None


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why there is no order: movers that can't all reach their goals whatever the others do (`core`, proven), or none
    known; the configuration that came closest; the paths that were blocked on the way."""

    table: Conflicts
    core: tuple[int, ...]
    closest: Configuration
    proven: bool
    blocked: tuple[NoPath, ...] = ()


@dataclass(slots=True)
class Problem:
    """One planning problem. `asides`: components that are right but may be moved to make room, as movers; `direct`:
    only moves straight to the goal, of nobody else."""

    setup: Setup
    seen: Observation
    movers: tuple[Mover, ...]
    obstacles: tuple[Obstacle, ...]
    asides: tuple[Mover, ...]
    motion: Motion | None

    def widened(self, names: frozenset[str]) -> Problem:
        """Return the problem in which these components may be moved aside."""
        movers = (*self.movers, *(m for m in self.asides if m.name in names))
        rest = tuple(o for o in self.obstacles if o.name not in names)
        return Problem(self.setup, self.seen, movers, rest, (), self.motion)


def solve(problem: Problem) -> Solution | Refusal:
    """Return an order of moves, moving what is right only where there is none without; or why there is none."""
    first = attempt(problem)
    if isinstance(first, Solution):
        return first
    for names in _asides(problem, first):
        answer = attempt(problem.widened(names))
        if isinstance(answer, Solution):
            return answer
    return first


def attempt(problem: Problem) -> Solution | Refusal:
    """Return an order for exactly these movers, every path of it checked, or why there is none."""
    table = Conflicts(problem.setup, problem.movers, problem.obstacles, problem.motion)
    blocked: list[NoPath] = []
    while True:
        found, core = hunt(table)
        if found.steps is None:
            return Refusal(table, core, found.closest, bool(core) or found.exhausted, tuple(blocked))
        steps = shortened(table, found.steps)
        steps = arranged(problem.setup, table, steps, precedence(table, steps, {}))
        if problem.motion is None:
            return Solution(table, steps, None)
        paths = find_paths(table, steps, problem.seen, problem.motion)
        if isinstance(paths, Paths):
            return Solution(table, steps, paths)
        blocked.append(paths)
        if len(blocked) > PATH_ROUNDS:
            return Refusal(table, (), found.closest, False, tuple(blocked))
        table.forbid(paths.step.mover, paths.step.start, paths.step.goal, paths.step.hold, paths.spot)


def hunt(table: Conflicts) -> tuple[Found, tuple[int, ...]]:
    """Search with growing effort. Returns the last search, and movers that are proven not to get home, if any."""
    everyone = range(len(table.movers))
    for i in everyone:
        if not any(table.ways(i, 0, g) for g in table.movers[i].goals) and not table.movers[i].right:
            alone = search(table, PROOF, (i,))
            if alone.exhausted:
                return alone, (i,)
    for effort in EFFORTS:
        found = search(table, effort)
        if found.steps is not None:
            return found, ()
    core = _core(table, found.closest)
    if not core and len(table.movers) <= COMPLETE:
        return search(table, EVERYTHING), ()
    return found, core


def _core(table: Conflicts, closest: Configuration) -> tuple[int, ...]:
    """Return two or three movers that can't get home even where all others are taken off the table. On a large table
    threes are looked for only among those that the search did not bring home."""
    who = [i for i, m in enumerate(table.movers) if not m.right]
    stuck = [i for i in who if closest[i] not in table.movers[i].finished]
    small, arcs = len(who) <= COMPLETE, _arcs(table, who)
    work = PROOF_WORK
    for size, names in ((2, who), (3, who if small else stuck[:12])):
        for group in combinations(names, size):
            if work > 0 and _linked(group, arcs):
                found = search(table, PROOF, group)
                work -= found.expanded
                if found.exhausted:
                    return group
    return ()


def _arcs(table: Conflicts, who: Sequence[int]) -> set[tuple[int, int]]:
    """Return the pairs (a, b) where, in some hold, `a` must move before `b`: it stands in the way of `b`, or `b` at
    its goal would stand in its way."""
    needs = {i: table.hindrances(i) for i in who}
    goals = {i: sum_of(table.bit(i, g) for g in table.movers[i].goals) for i in who}
    return {(a, b) for a in who for b in who if a != b and (needs[b] & table.bit(a, 0) or needs[a] & goals[b])}


def _linked(group: Sequence[int], arcs: set[tuple[int, int]]) -> bool:
    """Whether each of the group waits for another of it and is waited for, as in a ring."""
    return all(any((a, b) in arcs for b in group) and any((b, a) in arcs for b in group) for a in group)


def _asides(problem: Problem, refused: Refusal) -> Iterator[frozenset[str]]:
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
