"""Why there is no order of moves, as few constraints as are enough: without any one of them the rest can be kept.

The constraints are those of the tables that the search looks at, told apart by who is concerned. Each is dropped in
turn, storage first, and stays dropped where it is proven that there is no order without it either.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from pico.model.plan import Blocking
from pico.model.plan import BlockingKind as Kind
from pico.motion.types import Blocked, MovePath, StandingObject
from pico.planning.ordering.conflicts import Conflicts, Spot, Way, sum_of
from pico.planning.ordering.paths import NoPath
from pico.planning.ordering.relaxed import relaxation
from pico.planning.ordering.search import Expansions, OrderedMove, SearchEffort, search
from pico.planning.parts.movers import Hold, Mover, Place
from pico.staging.feedback import Limit
from pico.staging.feedback import solve as fewest_staged

WORK = 60_000
"""Configurations looked at in all for one certificate."""
PATHS = 80
"""Paths asked for in all for one certificate."""
LIMIT = Limit(solves=15, nodes=500)
"""How hard to look for a proof that storage with room for all would not do."""
EACH = 6000
"""Configurations looked at for one constraint."""
QUICK = SearchEffort(weight=2.0, limit=200, commit=True, slots=3)
THOROUGH = SearchEffort(weight=2.0, limit=EACH, everyone=True)

Verdict = Literal["possible", "impossible", "unknown"]


@dataclass(frozen=True, slots=True)
class Certificate:
    """Whether it is `proven` that no order brings movers home, and constraints that no order keeps, without any one of
    which there is one that keeps the rest: None where these were not found within the limit of the search."""

    proven: bool
    blocking: tuple[Blocking, ...] | None = None


@dataclass(slots=True)
class Work(Expansions):
    """What may be spent on one certificate: configurations, and paths to be asked for (None: asked for none)."""

    paths: int | None = None


def certified(table: Conflicts, core: Sequence[int]) -> Certificate:
    """Return which constraints keep the movers of `core` (all of them where it is empty) from getting home, with
    nobody else on the table but what stays."""
    who = tuple(core) or tuple(range(len(table.movers)))
    work = Work(WORK, PATHS)
    kept = list(_constraints(table, who))
    if judged(table, who, kept, work) != "impossible":
        return Certificate(False)
    for kind in dict.fromkeys(c.kind for c in kept):
        less = [c for c in kept if c.kind != kind]
        kept = less if judged(table, who, less, work) == "impossible" else kept
    for one in tuple(kept):
        less = [c for c in kept if c != one]
        verdict = judged(table, who, less, work)
        if verdict == "unknown":
            return Certificate(True)
        kept = less if verdict == "impossible" else kept
    return Certificate(True, tuple(sorted(kept, key=lambda c: (c.kind, c.of, c.by))))


def stored_would_do(table: Conflicts, names: Iterable[str]) -> bool:
    """Whether everybody might get home if only these had room in storage."""
    who, had = range(len(table.movers)), set(names)
    kept = [c for c in _constraints(table, tuple(who)) if c.kind != "storage" or c.of not in had]
    return judged(table, tuple(who), kept, Work(EACH)) != "impossible"


def judged(table: Conflicts, who: Sequence[int], kept: Iterable[Blocking], work: Work) -> Verdict:
    """Return whether the movers `who` can get home by themselves where only the constraints `kept` count: possible
    only where there is a path for each move of which the path counts, too. What has none is forbidden in `table`."""
    while True:
        eased = Eased(table, who, kept)
        verdict, steps = _ordered(eased, work)
        if verdict != "possible" or work.paths is None:
            return verdict
        step = next(_without_path(eased, steps, work), None)
        if step is None:
            return "possible" if work.paths > 0 else "unknown"
        eased.forbid_in_full(step)


def _ordered(eased: Eased, work: Work) -> tuple[Verdict, tuple[OrderedMove, ...]]:
    work.left -= 20 + 5 * len(eased.movers)
    if work.left <= 0:
        return "unknown", ()
    relaxed = fewest_staged(relaxation(eased), LIMIT)
    if relaxed.options is None and relaxed.proven:
        return "impossible", ()
    if quick := search(eased, QUICK).steps:
        return "possible", quick
    share = Expansions(min(EACH, work.left))
    before = share.left
    found = search(eased, THOROUGH, work=share)
    work.left -= before - share.left
    if found.steps is not None:
        return "possible", found.steps
    return ("impossible" if found.exhausted else "unknown"), ()


def _without_path(eased: Eased, steps: Sequence[OrderedMove], work: Work) -> Iterator[NoPath]:
    """Yield the steps that have no path though it counts, all arms being parked before, and the last of an arm after
    which it can't park."""
    motion, places = eased.motion, [0] * len(eased.movers)
    last: dict[str, tuple[OrderedMove, MovePath]] = {}
    for step in steps:
        mover, robot = eased.movers[step.mover], step.hold.robot
        if motion and robot and eased.path_counts(step):
            work.paths = (work.paths or 0) - 1
            start, goal = (mover.places[p].pose for p in (step.start, step.goal))
            found = motion.move(robot, mover.name, start, goal, step.hold.yaw, eased.standing(places), None)
            if isinstance(found, Blocked):
                yield NoPath(step, found, eased.spot_of(found, places, step))
            else:
                last[robot] = step, found
        places[step.mover] = step.goal
        if work.paths is not None and work.paths <= 0:
            return
    for robot, (step, path) in last.items() if motion else ():
        parked = motion.park(robot, path.end, eased.standing(places)) if motion else None
        if isinstance(parked, Blocked):
            yield NoPath(step, parked, eased.spot_of(parked, places, step))


def _constraints(table: Conflicts, who: Sequence[int]) -> Iterator[Blocking]:
    """Yield every constraint on these movers, those first that are to be dropped first."""
    names = [table.movers[i].name for i in who]
    yield from (Blocking(kind="storage", of=name) for name in names)
    yield from (Blocking(kind="path", of=name) for name in names if table.motion)
    for i in who:
        others = dict.fromkeys(name for hold, place in _ends(table, i) for name in _near_fingers(table, i, place, hold))
        yield from (Blocking(kind="fingers", of=table.movers[i].name, by=name) for name in others)
    gripped, met = _meetings(table, who)
    yield from (Blocking(kind="fingers", of=a, by=b) for a in names for b in names if (a, b) in gripped)
    pairs = ((a, b) for n, a in enumerate(names) for b in names[n + 1 :])
    yield from (Blocking(kind="bodies", of=a, by=b) for a, b in pairs if (a, b) in met or (b, a) in met)
    yield from (Blocking(kind="stays", of=name) for name in names)
    yield from (Blocking(kind="reach", of=name) for name in names)


def _meetings(table: Conflicts, who: Sequence[int]) -> tuple[set[tuple[str, str]], set[tuple[str, str]]]:
    """Return the pairs of which the fingers around the first meet the second somewhere, and those that meet."""
    gripped, met = set[tuple[str, str]](), set[tuple[str, str]]()
    for i in who:
        name = table.movers[i].name
        places = range(len(table.movers[i].places))
        bodies = sum_of(table.near_body(i, p) for p in places)
        hands = sum_of(table.near_fingers(i, p, h) for p in places for h in table.movers[i].holds)
        met |= {(name, table.movers[j].name) for j, _ in table.at(bodies)}
        gripped |= {(name, table.movers[j].name) for j, _ in table.at(hands)}
    return gripped, met


def _ends(table: Conflicts, i: int) -> Iterator[tuple[Hold, int]]:
    mover = table.movers[i]
    yield from ((hold, place) for place in (0, *mover.goals) for hold in mover.holds)


def _near_fingers(table: Conflicts, i: int, place: int, hold: Hold) -> Iterator[str]:
    return (name for name, _ in table.finger_hits(i, place, hold))


class Eased(Conflicts):
    """The tables of a problem in which only `who` move, and only the constraints `kept` count. Who needs no storage may
    stand in the air meanwhile: its last place is in nobody's way."""

    def __init__(self, table: Conflicts, who: Sequence[int], kept: Iterable[Blocking]) -> None:
        self.__dict__.update(copy.copy(table).__dict__)
        self._full, self._who = table, tuple(who)
        self._kept = frozenset(kept)
        names = [table.movers[i].name for i in who]
        self._numbers = {name: n for n, name in enumerate(names)}
        self.more_slots = False
        self.movers = tuple(self._floating(table.movers[i]) for i in who)
        self.spots = [(n, p) for n, m in enumerate(self.movers) for p in range(len(m.places))]
        self._bits = {spot: 1 << k for k, spot in enumerate(self.spots)}
        self.ends = sum_of(self._bits[n, p] for n, m in enumerate(self.movers) for p in {0, *m.goals})
        self._arrive, self._grip, self._ways = {}, {}, {}

    def _has(self, kind: Kind, of: str, by: str = "") -> bool:
        return Blocking(kind=kind, of=of, by=by) in self._kept

    def _floating(self, mover: Mover) -> Mover:
        if self._has("storage", mover.name):
            return mover
        air = len(mover.places)
        places = (*mover.places, Place(mover.start.pose, "in the air"))
        return replace(mover, places=places, staging=(*mover.staging, air), stages=True)

    def _in_the_air(self, i: int, place: int) -> bool:
        return place >= len(self._full.movers[self._who[i]].places)

    def path_counts(self, step: OrderedMove) -> bool:
        """Whether a step needs a free path: not to or from the air, and not where that constraint is not kept."""
        floats = any(self._in_the_air(step.mover, p) for p in (step.start, step.goal))
        return not floats and self._has("path", self.movers[step.mover].name)

    def standing(self, places: Sequence[int]) -> dict[str, StandingObject]:
        """Return everything that stands on the table where the movers are at `places`."""
        on_table = ((self.movers[n], p) for n, p in enumerate(places) if not self._in_the_air(n, p))
        found = {name: o.standing for name, o in self.obstacles.items()}
        return found | {m.name: StandingObject(m.places[p].pose, m.geometry) for m, p in on_table}

    def spot_of(self, blocked: Blocked, places: Sequence[int], step: OrderedMove) -> Spot | None:
        """Return the spot of the mover that is in the way of a step, if one is."""
        n = self._numbers.get(blocked.obstacle or "")
        return None if n is None or n == step.mover else (n, places[n])

    def forbid_in_full(self, no: NoPath) -> None:
        """Exclude a move that has no path from the tables that were eased."""
        i, spot = self._who[no.step.mover], no.spot and (self._who[no.spot[0]], no.spot[1])
        self._full.forbid(i, no.step.start, no.step.goal, no.step.hold, spot)

    def _only(self, mask: int, i: int, kind: Kind) -> int:
        """Translate a mask of the full table, but for what is not kept."""
        name, found = self.movers[i].name, 0
        for j, place in self._full.at(mask):
            other = self._full.movers[j].name
            n = self._numbers.get(other)
            if n is not None and self._counts(kind, name, other):
                found |= self._bits[n, place]
        return found

    def _counts(self, kind: Kind, of: str, by: str) -> bool:
        if kind == "bodies":
            return self._has(kind, of, by) or self._has(kind, by, of)
        return self._has(kind, of, "" if kind == "path" else by)

    def arrive(self, i: int, place: int) -> int | None:
        """See `Conflicts.arrive`."""
        if self._in_the_air(i, place):
            return 0
        if (i, place) not in self._arrive:
            self._arrive[i, place] = self._eased_body(i, place)
        return self._arrive[i, place]

    def _eased_body(self, i: int, place: int) -> int | None:
        j, mover = self._who[i], self.movers[i]
        mask = self._full.arrive(j, place)
        if mask is None and (place in mover.staging or self._has("stays", mover.name)):
            return None
        if mask is None:
            mask = self._full.near_body(j, place)
        return self._only(mask, i, "bodies")

    def grip(self, i: int, place: int, hold: Hold) -> int | None:
        """See `Conflicts.grip`."""
        if self._in_the_air(i, place):
            return 0
        key = (i, place, hold)
        if key not in self._grip:
            self._grip[key] = self._eased_fingers(i, place, hold)
        return self._grip[key]

    def _eased_fingers(self, i: int, place: int, hold: Hold) -> int | None:
        j, mover = self._who[i], self.movers[i]
        mask = self._full.grip(j, place, hold)
        if mask is None and place in mover.staging:
            return None
        if mask is None:
            if any(self._has("fingers", mover.name, o) for o in _near_fingers(self._full, j, place, hold)):
                return None
            if self._has("stays", mover.name) and self._full.fingers_kept_out(j, place, hold):
                return None
            if self._has("reach", mover.name) and self._full.unreachable(j, place, hold):
                return None
            if self._has("path", mover.name) and (j, hold) in self._full.blocked_holds:
                return None
            mask = self._full.near_fingers(j, place, hold)
        return self._only(mask, i, "fingers")

    def held(self, i: int, start: int, goal: int, hold: Hold) -> int | None:
        """See `Conflicts.held`."""
        own = (self.arrive(i, goal), self.grip(i, start, hold), self.grip(i, goal, hold))
        if any(p is None for p in own):
            return None
        path: int | None = 0
        if self._has("path", self.movers[i].name) and not any(self._in_the_air(i, p) for p in (start, goal)):
            path = self._full.blocked_paths.get((self._who[i], start, goal, hold), 0)
        return None if path is None else sum_of(p for p in own if p) | self._only(path, i, "path")

    def ways(self, i: int, start: int, goal: int) -> tuple[Way, ...]:
        """See `Conflicts.ways`."""
        key = (i, start, goal)
        if key not in self._ways:
            self._ways[key] = tuple(self._find_ways(i, start, goal))
        return self._ways[key]
