"""Random small labs for refusals: a gantry, an arm or two, parts up to 300 mm tall, slots down to 40 mm apart; what
becomes of each is judged from outside. mm and deg."""

from __future__ import annotations

import heapq
import random
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

from brute_labs import Lab, Undecided
from certificates import faults
from checker import check, fingers
from random_labs import Case, _free

from pico.model.body import Body
from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import Lab as LabFile
from pico.model.lab import Margins, Part, Slot, Table
from pico.model.observation import Observation, ObservedComponent
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.motion.arms import ArmMotion
from pico.motion.types import MovePath, StandingObject
from pico.planning import PlanGoal, Planner

SIZE = (1200.0, 900.0)
CONFIGURATIONS, QUESTIONS = 60_000, 600
ARMS = {
    "gantry": {"arm1": Robot(model="gantry", mount=Mount(x=0, y=0))},
    "xarm7": {"arm1": Robot(mount=Mount(x=480, y=760, yaw=-90))},
    "two": {"arm1": Robot(mount=Mount(x=250, y=760, yaw=-90)), "arm2": Robot(mount=Mount(x=850, y=760, yaw=-90))},
}


def tall_case(seed: int) -> tuple[Case, str]:
    """Return the case of a seed, and which robots it has."""
    rng = random.Random(seed)
    robots = rng.choice(sorted(ARMS))
    high = rng.choice((250.0, 250.0, 330.0, 380.0))
    kinds = {f"type_{i}": _type(rng, f"type_{i}") for i in range(3)}
    mouth = random.Random(f"mouths of {seed}").choice((10.0, 10.0, 10.0, 22.5))
    if mouth > 10:  # wider than a thin part, so that others may cover it
        thin = kinds["type_2"].geometry
        kinds["type_2"] = replace(kinds["type_2"], geometry=replace(thin, footprint=Footprint(disc=9.0)))
    parts = {
        f"c{i}": Part(type=rng.choice(sorted(kinds)), home="s0", stage=rng.choice(("allowed",) * 6 + ("never",)),
                      seating="bolted" if rng.random() < 0.06 else None)
        for i in range(rng.randint(2, 5))
    }  # fmt: skip
    pitch, margin = rng.choice((40.0, 65.0, 90.0, 120.0)), rng.choice((0.0, 2.0))
    lab = LabFile(
        name="tall", table=Table(size=SIZE), inventory=parts, margins=Margins(body=margin, fingers=margin),
        robots={n: replace(r, transit_height=high) for n, r in ARMS[robots].items()},
        slots={f"s{i}": Slot(x=330 + pitch * i, y=230, capture=mouth) for i in range(rng.randint(1, 5))},
    )  # fmt: skip
    setup = Setup(lab=lab, catalog=kinds)
    around = rng.choice((60.0, 90.0, 150.0))
    while True:
        first = _arranged(rng, setup, around, {})
        second = first and _arranged(rng, setup, around, first)
        if first and second:
            break
        around *= 1.1
    seen = {n: ObservedComponent(pose=s.pose or lab.slots[s.slot or ""].pose) for n, s in first.items()}
    return Case(setup, Observation(backend="sim", components=seen), LabState(lab="tall", components=second)), robots


def _type(rng: random.Random, name: str) -> ComponentType:
    height, width = rng.choice((60.0, 100.0, 140.0, 200.0, 300.0)), rng.choice((30.0, 44.0))
    disc, box = rng.choice((30.0, 40.0, 58.0)), (rng.choice((50.0, 60.0, 90.0)), rng.choice((50.0, 60.0)))
    footprint = Footprint(disc=disc) if rng.random() < 0.4 else Footprint(box=box)
    yaws = rng.choice(((0.0, 90.0), (0.0, 90.0), (0.0,), (90.0,)))
    bodies = (
        Body(name="base", shape="box", size=(50.0, 50.0, 12.0), at=(0.0, 0.0, 6.0)),
        Body(name="post", shape="box", size=(width, width, height - 12), at=(0.0, 0.0, 6 + height / 2)),
    )
    grasp = Grasp(height=height - rng.choice((10.0, 30.0)), width=width, yaws=yaws)
    return ComponentType(
        name=name,
        title=name,
        geometry=Geometry(footprint=footprint, height=height, mass=0.5, bodies=bodies, grasp=grasp),
    )


def _arranged(
    rng: random.Random, setup: Setup, around: float, before: dict[str, ComponentState]
) -> dict[str, ComponentState] | None:
    """Return places for all parts, in slots or near the middle, many where another part stood or stays."""
    chosen: dict[str, ComponentState] = {}
    for name in rng.sample(sorted(setup.lab.inventory), len(setup.lab.inventory)):
        for n in range(80):
            spot = ComponentState(pose=Pose(
                round(rng.gauss(480, around)), round(rng.gauss(420, around / 2)), rng.choice((0.0, 0.0, 90.0, 30.0))
            ))  # fmt: skip
            if before and (setup.seating_of(name) == "bolted" or rng.random() < 0.2):
                spot = before[name]
            elif before and n < 12 and rng.random() < 0.7:
                other = before[rng.choice(sorted(before))]
                spot = other if other.slot else ComponentState(pose=other.pose)
            elif rng.random() < 0.25 and setup.seating_of(name) != "bolted":
                spot = ComponentState(slot=rng.choice(sorted(setup.lab.slots)))
            if _free(setup, name, spot, chosen):
                chosen[name] = spot
                break
        else:
            return None
    return chosen


class TallLab(Lab):
    """A lab by brute force in which each hold belongs to an arm, and -1 is a hold that no arm has there."""

    def __init__(self, case: Case, motion: ArmMotion) -> None:
        self.motion = motion
        self._rooms: dict[tuple[int, int], list[int]] = {}
        self._asked: dict[object, bool] = {}
        super().__init__(case)

    def arms(self, i: int) -> list[tuple[str, float]]:
        grasp = self.setup.type_of(self.names[i]).geometry.grasp
        return [(robot, yaw) for robot in sorted(self.setup.lab.robots) for yaw in (grasp.yaws if grasp else ())]

    def rooms(self, i: int, p: int) -> list[int]:
        if (i, p) not in self._rooms:
            self._rooms[i, p] = list(self._masks(i, p))
        return self._rooms[i, p]

    def _masks(self, i: int, p: int) -> Iterator[int]:
        geometry, lab = self.setup.type_of(self.names[i]).geometry, self.setup.lab
        for robot, yaw in self.arms(i) if self.by_arm[i] else ():
            zones, lowest = fingers(geometry, lab.robots[robot].gripper, yaw, self.spots[i][p].pose)
            masks = [self._near(i, zone, max(lab.margins.fingers - 1e-6, 0.0), lowest) for zone in zones]
            yield masks[0] | masks[1]
        if not self.by_arm[i]:
            yield 0

    def _fingers(self, i: int, p: int) -> Iterator[int]:
        if not self.by_arm[i]:
            yield 0
            return
        for (robot, yaw), mask in zip(self.arms(i), self.rooms(i, p), strict=True):
            yield -1 if self.motion.reach(robot, self.names[i], self.spots[i][p].pose, yaw) else mask

    paths = True

    def goes(self, i: int, places: dict[int, int], p: int, hold: int, parks: bool) -> bool:
        """Whether an arm, parked before, has a path for a component to a spot in one of its holds, and (`parks`) parks
        after it. Raises Undecided after many questions."""
        key = (i, places[i], p, hold, parks, tuple(sorted((j, q) for j, q in places.items() if j != i)))
        if key not in self._asked:
            if len(self._asked) >= QUESTIONS:
                raise Undecided
            self._asked[key] = self._path(i, places, p, hold, parks)
        return self._asked[key]

    def _path(self, i: int, places: dict[int, int], p: int, hold: int, parks: bool) -> bool:
        kind = {n: self.setup.type_of(n).geometry for n in self.names}
        name, start, goal = self.names[i], self.spots[i][places[i]].pose, self.spots[i][p].pose
        standing = {
            self.names[j]: StandingObject(self.spots[j][q].pose, kind[self.names[j]]) for j, q in places.items()
        }
        robot, yaw = self.arms(i)[hold]
        path = self.motion.move(robot, name, start, goal, yaw, standing)
        if not parks or not isinstance(path, MovePath):
            return isinstance(path, MovePath)
        after = standing | {name: StandingObject(goal, kind[name])}
        return isinstance(self.motion.park(robot, path.end, after), MovePath)

    def made(self, i: int, places: dict[int, int], p: int) -> bool:
        """Whether some arm brings a component to a spot, and parks."""
        taken = sum(self.bit(j, q) for j, q in places.items())
        rooms = zip(self.holds(i, places[i]), self.holds(i, p), strict=True)
        free = [hold for hold, (a, b) in enumerate(rooms) if not (a | b) & taken]
        return not self.by_arm[i] or any(self.goes(i, places, p, hold, parks=True) for hold in free)


def way_out(case: Case, motion: ArmMotion) -> str:
    """Return the moves that bring a lab to its state, each begun and ended with all arms parked; empty where there are
    none, which may show for one or two of the parts alone. Raises Undecided where it takes too many questions to find
    that out."""
    lab = TallLab(case, motion)
    still = tuple(i for i in range(len(lab.names)) if lab.right(i) and not lab.by_arm[i])
    who = tuple(i for i in range(len(lab.names)) if i not in still)
    for group in (*combinations(who, 1), *combinations(who, 2)):
        if len(group) < len(who) and not all(lab.right(i) for i in group):
            try:
                if _way(TallLab(case, motion), group, still) is None:
                    return ""
            except Undecided:
                continue
    return _way(lab, who, still) or ""


def _way(lab: TallLab, who: tuple[int, ...], still: tuple[int, ...]) -> str | None:
    """Return the moves that bring some parts home, with nobody else there but those that stay."""
    start = (0,) * len(who)
    heap: list[tuple[float, int, int, tuple[int, ...], str]] = [(float(lab._left(who, start)), 0, 0, start, "")]
    came: dict[tuple[int, ...], tuple[int, int, tuple[int, ...]]] = {}
    seen, pushed = set[tuple[int, ...]](), 0
    while heap:
        _, key, cost, state, told = heapq.heappop(heap)
        if state in seen:
            continue
        if key:
            i, p, before = came[key]
            if not lab.made(i, dict(zip(who, before, strict=True)) | dict.fromkeys(still, 0), p):
                continue
        seen.add(state)
        if not lab._left(who, state):
            return told or "nothing to do"
        for i, p in lab.moves(dict(zip(who, state, strict=True)) | dict.fromkeys(still, 0), who):
            after = tuple(p if j == i else q for j, q in zip(who, state, strict=True))
            if after not in seen:
                pushed += 1
                came[pushed] = i, p, state
                guess = cost + 1 + 3 * lab._left(who, after)
                heapq.heappush(
                    heap, (guess, pushed, cost + 1, after, f"{told}{lab.names[i]} to {lab.spots[i][p].pose}; ")
                )
        if len(seen) > CONFIGURATIONS:
            raise Undecided
    return None


@dataclass(frozen=True)
class Judged:
    """What became of a lab: planned, or refused and why; how long that took [s]; what was wrong; what nobody knows."""

    robots: str
    refused: str
    seconds: float
    wrong: tuple[str, ...]
    undecided: tuple[str, ...]


def judge(seed: int) -> Judged:
    """Plan the lab of a seed with its arms, and judge plan or refusal by brute force."""
    case, robots = tall_case(seed)
    motion = ArmMotion(case.setup)
    began = time.process_time()
    made = Planner(case.setup, motion, case.seen).plan(PlanGoal(case.wanted))
    took = time.process_time() - began
    errors = [d for d in made.diagnostics if d.severity == "error"]
    if not errors:
        wrong = check(case.setup, case.seen, case.wanted, made, seed=seed, extensions=2) + _left(made)
        return Judged(robots, "", took, tuple(wrong), ())
    wrong, undecided = [], []
    try:
        found = way_out(case, motion)
        wrong += [f"refused, but there is a way ({found}): {errors[0].summary}"] if found else []
    except Undecided:
        undecided.append("refusal")
    told, unknown = _reasons(case, made, motion)
    return Judged(robots, errors[0].summary, took, tuple(wrong + told), tuple(undecided + unknown))


def _left(made: Plan) -> list[str]:
    """Return the arms that a plan moves and does not park at last."""
    last = {o.robot: o.primitive for o in made.operations if o.robot}
    stuck = [f"{robot} is not parked" for robot, primitive in last.items() if primitive != "park"]
    return stuck + [d.summary for d in made.diagnostics if "park" in d.summary]


def _reasons(case: Case, made: Plan, motion: ArmMotion) -> tuple[list[str], list[str]]:
    """Return what is wrong with the reason of a refusal, and what nobody knows of it."""
    if made.blocking is None:
        why = any("the limit of" in d.detail or "its limit of" in d.detail for d in made.diagnostics)
        return ([], ["no certificate"]) if why else (["no certificate, and no word why"], [])
    try:
        return [f"false reason: {f}" for f in faults(TallLab(case, motion), made.blocking)], []
    except Undecided:
        return [], ["certificate"]
