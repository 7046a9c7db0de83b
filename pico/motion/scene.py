"""What one arm could hit: table, keep-out zones, the other arms, everything that stands, and the arm itself.

Compiled once and then only rearranged: components are mocap bodies (MuJoCo misses collisions of static bodies that
are moved), as many of each geometry as stood within reach at once. The part in hand is a body of the gripper; it is
switched by the collision bits of its body and its geoms, because MuJoCo looks at both.

Contacts are made as soon as things are `FREE` from being too near to one another, so that a look at one configuration
tells how far the arm may move before it has to look again.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from pico.model.catalog import Geometry
from pico.model.lab import KeepOut
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.arm import ARM_BIT, WORLD_BIT, attach_arm, build_arm
from pico.motion.engine import add_solids, require_mujoco
from pico.motion.reach import grasp_height
from pico.motion.types import Joints, StandingObject

FREE = 10.0
"""How much farther off than its margin a thing is first noticed [mm]."""
_ROUNDING = 0.01  # mm; what stands exactly at a margin is not too near
_AWAY = (0.0, -20.0, 0.0)  # m, where bodies wait that stand for nothing at present
_DEG = math.pi / 180

Place = Literal["component", "keep_out", "table", "robot", "self"]


@dataclass(frozen=True, slots=True)
class Hit:
    """What comes too near: `part` of the arm (`link4`, `finger`, `gripper`, `held`) and the `obstacle`.

    `gap` is the distance between them, negative where they overlap; `missing` what it falls short of [mm].
    """

    part: str
    obstacle: str
    kind: Place
    gap: float
    missing: float


class Scene:
    """The surroundings of one arm of a lab. Not thread-safe: a scene is arranged and then asked."""

    def __init__(self, setup: Setup, robot: str, pool: Mapping[Geometry, int]) -> None:
        """Compile a scene that takes up to `pool[geometry]` components of each geometry."""
        self.setup, self.name, self.robot = setup, robot, setup.lab.robots[robot]
        self.pool = dict(pool)
        margins = setup.lab.margins
        self._world = {
            "contype": WORLD_BIT,
            "conaffinity": ARM_BIT,
            "margin": (FREE + max(margins.body, margins.fingers)) / 1000,
        }
        self._compile()
        self.ignored: frozenset[str] = frozenset()
        """Components that the fingers may touch: what they stand around when a motion begins."""
        self.required = {"held": margins.body, "finger": margins.fingers}
        self._default = margins.body
        self._arranged: dict[str, StandingObject] = {}
        self._held: int | None = None

    def _compile(self) -> None:
        require_mujoco()
        import mujoco

        spec = mujoco.MjSpec()
        self._add_surroundings(spec)
        places = self._add_pool(spec)
        self._add_robots(spec)
        self._model: Any = spec.compile()
        self._data: Any = mujoco.MjData(self._model)
        self._kinematics, self._collision = mujoco.mj_kinematics, mujoco.mj_collision
        self._index(places)

    def _add_surroundings(self, spec: Any) -> None:
        import mujoco

        box = mujoco.mjtGeom.mjGEOM_BOX
        x, y = (v / 2000 for v in self.setup.lab.table.size)
        table = spec.worldbody.add_body(name="table")
        table.add_geom(type=box, size=[x, y, 0.05], pos=[x, y, -0.05], **self._world)
        for name, zone in self.setup.lab.keep_out.items():
            body = spec.worldbody.add_body(name=f"keep_out:{name}")
            body.add_geom(type=box, **_extent(zone), **self._world)

    def _add_pool(self, spec: Any) -> dict[int, list[str]]:
        places: dict[int, list[str]] = {}
        for number, (geometry, count) in enumerate(self.pool.items()):
            places[number] = [f"place:{number}:{i}" for i in range(count)]
            for name in places[number]:
                add_solids(spec, spec.worldbody.add_body(name=name, mocap=True, pos=_AWAY), geometry, **self._world)
        return places

    def _add_robots(self, spec: Any) -> None:
        for name, robot in self.setup.lab.robots.items():
            if robot.model != "xarm7":
                continue
            arm = build_arm(robot)
            if name == self.name:
                self._add_hands(arm)
            else:
                for geom in arm.geoms:
                    if geom.contype:
                        geom.contype, geom.conaffinity = WORLD_BIT, ARM_BIT
                        geom.margin = self._world["margin"]
            attach_arm(spec, name, robot, arm)

    def _add_hands(self, arm: Any) -> None:
        """Give the gripper a body for each geometry that it may carry."""
        for number, geometry in enumerate(self.pool):
            if geometry.grasp is not None:
                depth = (self.robot.gripper.tool + grasp_height(self.robot, geometry)) / 1000
                body = arm.body("gripper").add_body(name=f"held:{number}", pos=[0, 0, depth])
                add_solids(arm, body, geometry, contype=ARM_BIT, conaffinity=ARM_BIT)

    def _index(self, places: Mapping[int, list[str]]) -> None:
        """Remember where everything is in the model's arrays, and park the other arms."""
        model = self._model
        self._numbers = {geometry: number for number, geometry in enumerate(self.pool)}
        self._known: dict[int, tuple[Geometry, int]] = {}
        self._mocaps = {n: [int(model.body(p).mocapid[0]) for p in names] for n, names in places.items()}
        self._occupant: dict[int, str] = {}
        self._roles = [self._role(model.body(int(b)).name) for b in model.geom_bodyid]
        self._mocap_of_geom = [int(model.body_mocapid[b]) for b in model.geom_bodyid]
        self._hands = {n: model.body(f"{self.name}/held:{n}").id for n, g in enumerate(self.pool) if g.grasp}
        for number in self._hands:
            self._switch(number, False)
        self._joints = slice(model.joint(f"{self.name}/joint1").qposadr[0], None)
        start = self._joints.start
        self._joints = slice(start, start + 7)
        self._slides = slice(start + 7, start + 9) if self.robot.gripper.fingers != "none" else None
        self._others = {
            name: int(model.joint(f"{name}/joint1").qposadr[0])
            for name, robot in self.setup.lab.robots.items()
            if name != self.name and robot.model == "xarm7"
        }
        parked = {name: tuple(math.radians(q) for q in self.setup.lab.robots[name].park) for name in self._others}
        self.place_robots(parked)

    def _role(self, body: str) -> tuple[Literal["own", "held"] | Place, str]:
        """What a body is: (`own`, part), (`held`, ""), or what kind of obstacle, and its name."""
        head, _, rest = body.partition("/")
        if head == self.name:
            return ("held", "") if rest.startswith("held:") else ("own", rest)
        if rest:
            return "robot", head
        kind, _, name = body.partition(":")
        if kind == "place":
            return "component", ""
        return ("keep_out", name) if kind == "keep_out" else ("table", "table")

    def place_robots(self, joints: Mapping[str, Joints]) -> None:
        """Put the other arms where they stand [rad], their grippers shut."""
        for name, at in self._others.items():
            if name in joints:
                self._data.qpos[at : at + 7] = joints[name]

    def lacks(self, standing: Iterable[StandingObject]) -> Counter[Geometry]:
        """Return how many places of each geometry `standing` needs beyond those that the scene has."""
        need = Counter(self._number(s.geometry) for s in standing)
        if -1 not in need and all(count <= len(self._mocaps[n]) for n, count in need.items()):
            return Counter()
        full = Counter(s.geometry for s in standing)
        return Counter({g: n for g, n in full.items() if n > self.pool.get(g, 0)})

    def _number(self, geometry: Geometry) -> int:
        known = self._known.get(id(geometry))
        if known is None:
            if len(self._known) > 10_000:  # shapes of strangers are made anew with every observation
                self._known.clear()
            known = self._known[id(geometry)] = (geometry, self._numbers.get(geometry, -1))
        return known[1]

    def arrange(self, standing: Mapping[str, StandingObject]) -> None:
        """Put components where `standing` has them, and everything else away. Each must have a place: see `lacks`."""
        if standing == self._arranged:
            return
        free = {number: iter(mocaps) for number, mocaps in self._mocaps.items()}
        self._data.mocap_pos[:] = _AWAY
        self._occupant = {}
        for name in sorted(standing):
            thing = standing[name]
            mocap = next(free[self._number(thing.geometry)])
            self._occupant[mocap] = name
            half = thing.pose.yaw * _DEG / 2
            self._data.mocap_pos[mocap] = (thing.pose.x / 1000, thing.pose.y / 1000, 0.0)
            self._data.mocap_quat[mocap] = (math.cos(half), 0.0, 0.0, math.sin(half))
        self._arranged = dict(standing)

    def hold(self, geometry: Geometry | None, grasp_yaw: float = 0.0) -> None:
        """Put a part of `geometry` into the hand, gripped along `grasp_yaw` [deg] of its frame; None empties it."""
        if self._held is not None:
            self._switch(self._held, False)
            self._held = None
        if geometry is not None:
            self._held = self._number(geometry)
            # half a turn about an axis across the tool: the tool's z points down, the part's up
            half = (90.0 + grasp_yaw) * _DEG / 2
            self._model.body_quat[self._hands[self._held]] = (0.0, math.cos(half), math.sin(half), 0.0)
            self._switch(self._held, True)

    def _switch(self, number: int, on: bool) -> None:
        model, body = self._model, self._hands[number]
        first = model.body_geomadr[body]
        geoms = slice(first, first + model.body_geomnum[body])
        bits = ARM_BIT if on else 0
        model.geom_contype[geoms] = model.body_contype[body] = bits
        model.geom_conaffinity[geoms] = model.body_conaffinity[body] = bits

    def open(self, opening: float) -> None:
        """Set the distance between the pads [mm]."""
        if self._slides is not None:
            self._data.qpos[self._slides] = opening / 2000

    def look(self, joints: Joints) -> tuple[float, Hit | None]:
        """Return how far the arm, at `joints` [rad], is from coming too near to anything [mm, at most `FREE`], and the
        worst hit where it is too near."""
        data = self._data
        data.qpos[self._joints] = joints
        self._kinematics(self._model, data)
        self._collision(self._model, data)
        if data.ncon == 0:
            return FREE, None
        return self._judge(data.contact.geom.tolist(), data.contact.dist.tolist())

    def _judge(self, pairs: list[list[int]], distances: list[float]) -> tuple[float, Hit | None]:
        slack: float = FREE
        worst: Hit | None = None
        for (one, other), distance in zip(pairs, distances, strict=True):
            hit = self._assess(one, other, distance * 1000)
            if hit is None:
                continue
            slack = min(slack, -hit.missing)
            if hit.missing > _ROUNDING and (worst is None or hit.missing > worst.missing):
                worst = hit
        return slack, worst

    def _assess(self, one: int, other: int, gap: float) -> Hit | None:
        """Return what a contact means, or None for one that does not count."""
        mine, its = self._roles[one], self._roles[other]
        if mine[0] not in ("own", "held"):
            one, other, mine, its = other, one, its, mine
        if its[0] == "own" or its[0] == "held":
            return self._own_pair(mine, its, gap)
        part = "held" if mine[0] == "held" else _part(mine[1])
        if part == "base" or (part == "held" and its[0] == "table"):
            return None
        if its[0] != "component":
            return Hit(part, its[1], its[0], gap, -gap)
        name = self._occupant.get(self._mocap_of_geom[other], "")
        if name in self.ignored and part in ("finger", "gripper"):
            return None
        return Hit(part, name, "component", gap, self.required.get(part, self._default) - gap)

    def _own_pair(self, mine: tuple[str, str], its: tuple[str, str], gap: float) -> Hit:
        first, second = (its, mine) if its[0] == "held" else (mine, its)
        part = "held" if first[0] == "held" else _part(first[1])
        return Hit(part, f"{self.name} {_part(second[1])}", "self", gap, -gap)


def _part(body: str) -> str:
    return "finger" if body.endswith("_finger") else body


def _extent(zone: KeepOut) -> dict[str, list[float]]:
    bounds = (zone.area.x, zone.area.y, zone.z)
    return {
        "pos": [(low + high) / 2000 for low, high in bounds],
        "size": [max(high - low, 1e-3) / 2000 for low, high in bounds],
    }


def within_reach(
    setup: Setup, robot: str, standing: Mapping[str, StandingObject], reach: float
) -> dict[str, StandingObject]:
    """Return what stands so near to the robot's base that an arm `reach` mm long could touch it."""
    mount = setup.lab.robots[robot].mount
    base = Pose(mount.x, mount.y)
    return {
        name: thing
        for name, thing in standing.items()
        if base.distance(thing.pose) - thing.geometry.footprint.radius < reach
    }
