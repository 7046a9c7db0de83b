"""What a plan moves, where each thing may stand on the way, how it may be held, and what else stands on the table."""

from __future__ import annotations

import math
from collections.abc import Container, Sequence, Set
from dataclasses import dataclass, replace
from heapq import nsmallest

from pico.geometry import Shape, disc, fits, half_turn_symmetric, placed
from pico.model.catalog import Footprint, Geometry
from pico.model.observation import Observation, ObservedComponent, slot_at
from pico.model.pose import Pose, wrap
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.motion.types import StandingObject

AVOID_PENALTY = 2.0
"""What staging a part with `stage: avoid` costs beyond the move itself, in moves."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a component may stand: a pose, and the slot that it belongs to, if any."""

    pose: Pose
    slot: str | None = None

    def __str__(self) -> str:
        return self.slot or str(self.pose)


@dataclass(frozen=True, slots=True)
class Hold:
    """What moves a component: a robot whose jaws close along `yaw` [deg] in the component's frame, or a person
    (no robot), who needs no room for fingers."""

    robot: str | None
    yaw: float = 0.0


@dataclass(frozen=True, slots=True)
class Mover:
    """A component that a plan may move. `places[0]` is where it stands; `goals` and `staging` index `places`.

    `right`: it stands where it should, and is only moved to make room. `stages`: it may be put down in storage on its
    way; `penalty`: at which extra cost, in moves.
    """

    name: str
    geometry: Geometry
    places: tuple[Place, ...]
    goals: tuple[int, ...]
    staging: tuple[int, ...]
    holds: tuple[Hold, ...]
    right: bool
    penalty: float
    stages: bool

    @property
    def start(self) -> Place:
        return self.places[0]

    @property
    def goal(self) -> Place:
        """Where it is preferred to end."""
        return self.places[next((g for g in self.goals if g), 0)]

    @property
    def finished(self) -> frozenset[int]:
        """The places where it is right."""
        return frozenset(self.goals) | ({0} if self.right else frozenset())


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Something that stays where it is."""

    name: str
    shape: Shape
    height: float
    standing: StandingObject


def turned(setup: Setup, slot: str, footprint: Footprint) -> list[Place]:
    """Return how a part may stand in a slot: as the slot says, or turned by quarters, which the fingers may need.

    Half a turn is left out where it changes nothing; the wrist does not need it, since either jaw may come first.
    """
    pose = setup.lab.slots[slot].pose
    turns = (0, 90) if half_turn_symmetric(footprint) else (0, 180, 90, 270)
    return [Place(Pose(pose.x, pose.y, wrap(pose.yaw + t)), slot) for t in turns]


def mover(
    setup: Setup, seen: Observation, wanted: LabState, name: str, robots: tuple[str, ...], *, right: bool
) -> Mover:
    """Return what may be done with a component that is `seen`; `robots` are those with a free gripper."""
    part, kind, pose = setup.lab.inventory[name], setup.type_of(name), seen.components[name].pose
    assert pose is not None
    movable = setup.movable(name)
    footprint = kind.geometry.footprint
    slot, goal = place_of(setup, wanted, name)
    places = [Place(pose, slot_at(setup, pose) if movable else None)]
    ends = turned(setup, slot, footprint) if slot and movable else [Place(goal, slot)]
    goals = tuple(range(1, 1 + len(ends)))
    holds = _holds(setup, name, robots) if movable and setup.lab.robots else (Hold(None),)
    penalty = AVOID_PENALTY if part.stage == "avoid" else 0.0
    stages = movable and part.stage != "never"
    return Mover(name, kind.geometry, (*places, *ends), goals, (), holds, right, penalty, stages)


def with_storage(setup: Setup, mover: Mover, free: Sequence[str], wanted: Set[str | None], most: int) -> Mover:
    """Return a mover that may be put down meanwhile in those of the `free` slots that take it: at most so many, those
    that are not `wanted` by others before the rest, the nearest to its goal first."""
    if not mover.stages:
        return mover
    footprint, goal, known = mover.geometry.footprint, mover.goal, setup.lab.slots
    slots = [s for s in free if s != goal.slot and fits(known[s], footprint)]

    def rank(s: str) -> tuple[bool, float, str]:
        return s in wanted, math.hypot(known[s].x - goal.pose.x, known[s].y - goal.pose.y), s

    slots = nsmallest(most, slots, key=rank)
    spots = [place for slot in slots for place in turned(setup, slot, footprint)]
    staging = tuple(range(len(mover.places), len(mover.places) + len(spots)))
    return replace(mover, places=(*mover.places, *spots), staging=staging)


def _holds(setup: Setup, name: str, robots: tuple[str, ...]) -> tuple[Hold, ...]:
    geometry, arms = setup.type_of(name).geometry, setup.lab.robots
    able = (robot for robot in robots if not arms[robot].too_heavy(geometry.mass))
    return tuple(Hold(robot, yaw) for robot in able for yaw in (geometry.grasp.yaws if geometry.grasp else ()))


def obstacle(setup: Setup, name: str, part: ObservedComponent) -> Obstacle | None:
    """Return a component of the inventory as something that stays where it is; None where it is not on the table."""
    if part.pose is None or part.presence in ("missing", "held"):
        return None
    geometry = setup.type_of(name).geometry
    if part.presence == "toppled":
        return _lying(name, part.pose, geometry)
    shape = placed(geometry.footprint, part.pose)
    return Obstacle(name, shape, geometry.height, StandingObject(part.pose, geometry))


def _lying(name: str, pose: Pose, geometry: Geometry) -> Obstacle:
    """A part that lies on its side may reach as far as it was tall, in any direction."""
    radius = geometry.height + geometry.footprint.radius
    height = max(geometry.height, 2 * geometry.footprint.radius)
    lying = Geometry(footprint=Footprint(disc=radius), height=height, mass=geometry.mass)
    return Obstacle(name, disc(pose.x, pose.y, radius), height, StandingObject(pose, lying))


def strangers(seen: Observation) -> list[Obstacle]:
    """Return the objects that the inventory does not have."""
    found = []
    for name, thing in sorted(seen.unknown.items()):
        geometry = Geometry(footprint=thing.footprint, height=thing.height, mass=0.0)
        shape = placed(thing.footprint, thing.pose)
        found.append(Obstacle(name, shape, thing.height, StandingObject(thing.pose, geometry)))
    return found


def standing_obstacles(setup: Setup, seen: Observation, moving: Container[str]) -> list[Obstacle]:
    """Return everything on the table that is not `moving`."""
    parts = []
    for name, part in seen.components.items():
        if name in moving or name not in setup.lab.inventory:
            continue
        thing = obstacle(setup, name, part)
        if thing:
            parts.append(thing)
    return [*parts, *strangers(seen)]
