"""The second look at a path that was found: other kinematics, other collision code, every 5 mrad.

Shares with the first look (`pico.motion.scene`) what the shapes are, and nothing else: numpy kinematics, fcl distances
with a separating plane as proof. Where it finds something too near that the first look took for free, the path is
refused. Every shape of the arm is taken `INSET` smaller and half a margin is enough, because the first look judges
between its own looks, so that the two never differ over rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations
from typing import Any

import numpy as np

from pico.model.catalog import Geometry
from pico.model.lab import KeepOut
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion import frames
from pico.motion.arm import NEIGHBORS
from pico.motion.explain import Errand, blocked
from pico.motion.hulls import Hull, of_geometry, of_shapes
from pico.motion.reach import grasp_height
from pico.motion.scene import Hit
from pico.motion.shapes import LINKS, cup, finger, palm
from pico.motion.sweep import ROUNDING, Leg, Thing, march, moving, still
from pico.motion.types import Blocked, Joints, MovePath, Segment, SegmentName, StandingObject

STEP = 0.005
"""Greatest step of a joint between two configurations that are looked at [rad]."""
INSET = 0.25e-3
"""How much smaller than declared the shapes of the arm and of the part in hand are taken [m]."""
TOUCHING = 1e-3
"""How much smaller still the part in hand is taken while it is lifted from neighbors that it may touch [m]."""
_JAW_GAP = 1.0  # mm, how much wider than the part the pads are taken to be while they close
_CARRYING = ("lift", "transit", "lower")

Array = Any
_BODIES = ("base", *(f"link{i}" for i in range(1, 8)), "gripper")


@dataclass(frozen=True, slots=True)
class Task:
    """What a path is for, as `pico.motion.moves.Move` was asked; all None for a park."""

    component: str | None = None
    geometry: Geometry | None = None
    start: Pose | None = None
    goal: Pose | None = None
    grasp_yaw: float = 0.0


class Recheck:
    """The second check of one arm's paths; knows nothing of the first."""

    def __init__(self, setup: Setup, robot: str) -> None:
        self.setup, self.name, self.robot = setup, robot, setup.lab.robots[robot]
        self._links = [(i, h) for i, part in enumerate(LINKS) for h in of_shapes(_BODIES[i], part, INSET)]
        self._links += [(frames.GRIPPER, h) for h in of_shapes("gripper", palm(self.robot.gripper), INSET)]
        if self.robot.gripper.fingers == "none":
            self._links += [(frames.GRIPPER, h) for h in of_shapes("gripper", [cup(self.robot.gripper.tool)], INSET)]
        self._fixed = [Thing(n, "keep_out", (_zone(z),), np.eye(3), np.zeros(3)) for n, z in setup.lab.keep_out.items()]
        self._fixed.append(Thing("table", "table", (_table(setup),), np.eye(3), np.zeros(3)))
        self._solids: dict[tuple[int, float], tuple[Geometry, tuple[Hull, ...]]] = {}
        self._other = lru_cache(maxsize=100)(lambda name, joints: _arm(name, setup.lab.robots[name], joints))
        self._pairs: dict[tuple[str, ...], tuple[Array, Array]] = {}

    def check(
        self, path: MovePath, task: Task, standing: Mapping[str, StandingObject], others: Mapping[str, Joints]
    ) -> Blocked | None:
        """Return why `path` is not free after all, or None where it is.

        `standing`: everything near, with or without the component itself; `others`: the joints of the other arms [rad].
        """
        robots = [self._other(name, joints) for name, joints in others.items()]
        errand = Errand(self.name, task.component, task.start, task.goal)
        around = {n: self._thing(n, s) for n, s in standing.items() if n != task.component}
        for segment in path.segments:
            hit = self._segment(segment, task, around, robots)
            if hit is not None:
                why = blocked(errand, segment.name, hit)
                text = f"the two collision checks disagree: the second one finds that {why.text}"
                help = "nothing is moved; leave more room there, and report this bench and plan as an error of PICO"
                return replace(why, kind="collision", text=text, help=help)
        return None

    def _segment(self, segment: Segment, task: Task, around: Mapping[str, Thing], robots: list[Thing]) -> Hit | None:
        joints = frames.densely(segment, STEP)
        carried = segment.name in _CARRYING and task.geometry is not None
        hold = (self.robot.gripper.tool / 1000, 0.0)
        hulls = [*self._links, *self._fingers(segment, task)]
        things = [*around.values(), *robots, *self._fixed]
        if carried and task.geometry is not None:
            hold = ((self.robot.gripper.tool + grasp_height(self.robot, task.geometry)) / 1000, task.grasp_yaw)
            inset = INSET + (TOUCHING if segment.name == "lift" else 0.0)
            hulls += [(frames.HELD, h) for h in self._hulls("held", task.geometry, inset)]
        elif task.geometry is not None and task.component is not None:
            pose = task.goal if segment.name in ("release", "retreat") else task.start
            things.append(self._thing(task.component, StandingObject(pose or Pose(0, 0), task.geometry)))
        plane = frames.in_plane(joints, hold)
        hit = self._with_itself(Leg(hulls, *plane))
        if hit is not None:
            return hit
        spin, base = frames.world(self.robot.mount, joints[:, 0])
        turns = spin[:, None] @ plane[0]
        origins = (spin[:, None] @ plane[1][..., None])[..., 0] + base
        leg = Leg(hulls, turns, origins)
        spared = self._spared(segment, task, around, origins, turns)
        return self._with_things(leg, things, segment.name, spared)

    def _fingers(self, segment: Segment, task: Task) -> list[tuple[int, Hull]]:
        gripper = self.robot.gripper
        if gripper.fingers == "none":
            return []
        closing = segment.name in ("grip", "release") and task.geometry is not None and task.geometry.grasp is not None
        width = task.geometry.grasp.width if task.geometry and task.geometry.grasp else 0.0
        opened = (width + _JAW_GAP if closing else segment.opening) / 2000
        found = []
        for side, name in ((1, "left_finger"), (-1, "right_finger")):
            for hull in of_shapes(name, finger(side, gripper.fingers, gripper.tool), INSET):
                found.append((frames.GRIPPER, replace(hull, center=hull.center + np.array((0.0, side * opened, 0.0)))))
        return found

    def _spared(
        self, segment: Segment, task: Task, around: Mapping[str, Thing], origins: Array, turns: Array
    ) -> dict[str, Array]:
        """For each component that the hand may touch, where on the way: what a stopped hand stands around is no
        obstacle until it has left it sideways, and a suction cup may touch what it takes."""
        everywhere = np.ones(len(origins), dtype=bool)
        spared = {task.component: everywhere} if task.component and self.robot.gripper.fingers == "none" else {}
        upright = turns[0, frames.GRIPPER, 2, 2] < -1 + 1e-6
        if segment.name in ("approach", "park") and upright:
            x, y = origins[0, frames.GRIPPER, :2]
            still = np.hypot(*(origins[:, frames.GRIPPER, :2] - (x, y)).T) < 1e-4
            for name, thing in around.items():
                if np.hypot(*(thing.origin[:2] - (x, y))) < max(
                    h.radius + np.hypot(*h.center[:2]) for h in thing.hulls
                ):
                    spared[name] = still
        return spared

    def _with_itself(self, leg: Leg) -> Hit | None:
        first, second = self._own_pairs(leg.parts)
        low, high = leg.bounds
        meet = (np.maximum(low[first] - high[second], low[second] - high[first]) < ROUNDING).all(axis=-1)
        first, second = first[meet], second[meet]
        apart = leg.centers[:, first] - leg.centers[:, second]
        near = np.einsum("npi,npi->np", apart, apart) < (leg.radii[first] + leg.radii[second]) ** 2
        for pair in np.flatnonzero(near.any(axis=0)).tolist():
            k, m = int(first[pair]), int(second[pair])
            may = near[:, pair] & leg.near(k, *leg.boxes(m)[1:], 0.0)
            gap = march(may, leg.covered(k) + leg.covered(m), 0.0, leg.measure(k, moving(leg, m)))
            if gap is not None:
                mine, its = sorted((leg.parts[k], leg.parts[m]), key=lambda part: part != "held")
                return Hit(_part(mine), f"{self.name} {_part(its)}", "self", gap * 1000, -gap * 1000)
        return None

    def _own_pairs(self, parts: tuple[str, ...]) -> tuple[Array, Array]:
        """Indices of the pairs of own hulls that do not touch by construction."""
        known = self._pairs.get(parts)
        if known is None:
            pairs = [p for p in combinations(range(len(parts)), 2) if not _joined(parts[p[0]], parts[p[1]])]
            first, second = np.array(pairs).T
            known = self._pairs[parts] = (first, second)
        return known

    def _with_things(
        self, leg: Leg, things: list[Thing], segment: SegmentName, spared: Mapping[str, Array]
    ) -> Hit | None:
        margins = np.array([self._margin(part, segment) for part in leg.parts])
        owners = [(thing, b) for thing in things for b in range(len(thing.hulls))]
        floors, ceilings = (np.concatenate([thing.bounds[side] for thing in things]) for side in (0, 1))
        low, high = leg.bounds
        apart = np.maximum(floors[None] - high[:, None], low[:, None] - ceilings[None]).max(axis=-1)
        for k, n in np.argwhere(apart < margins[:, None] + ROUNDING).tolist():
            part, (thing, b) = leg.parts[k], owners[n]
            if part == "base" or (part == "held" and thing.kind == "table"):
                continue
            required = float(margins[k]) if thing.kind == "component" else 0.0
            near = leg.near(k, floors[n], ceilings[n], required)
            if thing.name in spared and ("finger" in part or part == "gripper"):
                near &= ~spared[thing.name]
            if not near.any():
                continue
            other = thing.placed(b)
            gap = march(near, leg.covered(k), required, leg.measure(k, still(other)))
            if gap is not None:
                return Hit(_part(part), thing.name, thing.kind, gap * 1000, (required - gap) * 1000)
        return None

    def _margin(self, part: str, segment: SegmentName) -> float:
        """Half of what is kept between a part of the arm and a component [m]."""
        margins = self.setup.lab.margins
        if "finger" in part:
            return 0.0 if segment in ("grip", "release") else margins.fingers / 2000
        return 0.0 if part == "held" and segment == "lift" else margins.body / 2000

    def _thing(self, name: str, standing: StandingObject) -> Thing:
        pose = standing.pose
        turn = frames.about_z(math.radians(pose.yaw))
        hulls = self._hulls("component", standing.geometry, 0.0)
        return Thing(name, "component", hulls, turn, np.array((pose.x, pose.y, 0.0)) / 1000)

    def _hulls(self, part: str, geometry: Geometry, inset: float) -> tuple[Hull, ...]:
        known = self._solids.get((id(geometry), inset))
        if known is None:
            if len(self._solids) > 1000:  # shapes of strangers are made anew with every observation
                self._solids.clear()
            known = self._solids[id(geometry), inset] = (geometry, tuple(of_geometry(part, geometry, inset)))
        return known[1]


def _arm(name: str, robot: Robot, joints: Joints) -> Thing:
    """Another arm as it stands, its gripper shut."""
    links = [(i, h) for i, part in enumerate(LINKS) for h in of_shapes(_BODIES[i], part, 0.0)]
    links += [(frames.GRIPPER, h) for h in of_shapes("gripper", palm(robot.gripper), 0.0)]
    gripper = robot.gripper
    ends = [cup(gripper.tool)] if gripper.fingers == "none" else [
        shape for side in (1, -1) for shape in finger(side, gripper.fingers, gripper.tool)
    ]  # fmt: skip
    links += [(frames.GRIPPER, h) for h in of_shapes("finger", ends, 0.0)]
    posture = frames.one(joints)
    turns, origins = frames.in_plane(posture, (0.0, 0.0))
    spin, base = frames.world(robot.mount, posture[:, 0])
    placed = [
        replace(
            hull,
            turn=spin[0] @ turns[0, i] @ hull.turn,
            center=spin[0] @ (turns[0, i] @ hull.center + origins[0, i]) + base,
        )
        for i, hull in links
    ]
    return Thing(name, "robot", tuple(placed), np.eye(3), np.zeros(3))


def _joined(one: str, other: str) -> bool:
    """Whether two bodies of an arm touch by construction."""
    if one == other or ("held" in (one, other) and ("gripper" in (one, other) or "finger" in one + other)):
        return True
    if (one, other) in NEIGHBORS or (other, one) in NEIGHBORS:
        return True
    if "held" in (one, other):
        return False
    if "finger" in one + other:
        return "gripper" in (one, other)
    return abs(_BODIES.index(one) - _BODIES.index(other)) == 1


def _part(body: str) -> str:
    return "finger" if body.endswith("_finger") else body


def _zone(zone: KeepOut) -> Hull:
    bounds = [(low / 1000, max(high, low + 2e-3) / 1000) for low, high in (zone.area.x, zone.area.y, zone.z)]
    center = np.array([(low + high) / 2 for low, high in bounds])
    x, y, z = ((high - low) / 2 for low, high in bounds)
    return Hull("keep_out", "box", (x, y, z), center, np.eye(3))


def _table(setup: Setup) -> Hull:
    x, y = (v / 2000 for v in setup.lab.table.size)
    return Hull("table", "box", (x, y, 0.05), np.array((x, y, -0.05)), np.eye(3))
