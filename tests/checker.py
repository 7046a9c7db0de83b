"""Walks a plan step by step and says what is wrong with it.

Written from the design alone, to check the planner from outside: it knows the model, does its geometry with shapely,
and shares no code with `pico.geometry` or `pico.planning`. Lengths in mm, angles in deg.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from shapely import Point, Polygon
from shapely.affinity import rotate, translate

from pico.model.catalog import Footprint, Geometry
from pico.model.lab import Slot
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Gripper
from pico.model.setup import Setup
from pico.model.state import LabState, place_of

EPSILON = 1e-6


@dataclass(frozen=True)
class Base:
    """A footprint on the table: a polygon, or a point with a radius around it."""

    core: Polygon | Point
    radius: float = 0.0

    def gap(self, other: Base) -> float:
        """The distance between two bases; not above zero where they touch or overlap."""
        return self.core.distance(other.core) - self.radius - other.radius


@lru_cache(maxsize=10_000)
def base(footprint: Footprint, pose: Pose) -> Base:
    """Return a footprint standing at a pose."""
    if footprint.disc is not None:
        return Base(Point(pose.x, pose.y), footprint.disc)
    corners = footprint.polygon or _box_corners(*(footprint.box or (0.0, 0.0)))
    return Base(translate(rotate(Polygon(corners), pose.yaw, origin=(0, 0)), pose.x, pose.y))


def _box_corners(a: float, b: float) -> tuple[tuple[float, float], ...]:
    return ((-a / 2, -b / 2), (a / 2, -b / 2), (a / 2, b / 2), (-a / 2, b / 2))


@lru_cache(maxsize=10_000)
def fingers(geometry: Geometry, gripper: Gripper, yaw: float, pose: Pose) -> tuple[list[Base], float]:
    """Return the room that the open fingers need around a part, and how low they come."""
    grasp, finger = geometry.grasp, gripper.fingers
    assert grasp is not None
    if finger == "none":
        return [], grasp.height
    inner, outer = grasp.width / 2, grasp.width / 2 + finger.opening + finger.thickness
    zones = []
    for sign in (1, -1):
        middle = sign * (inner + outer) / 2
        corners = [(middle + x, y) for x, y in _box_corners(outer - inner, finger.breadth)]
        turned = rotate(Polygon(corners), pose.yaw + yaw, origin=(0, 0))
        zones.append(Base(translate(turned, pose.x, pose.y)))
    return zones, grasp.height - finger.tip


def slot_used(setup: Setup, name: str, pose: Pose) -> str | None:
    """Return the slot in which a part is at a pose, the nearest of those that capture it; what is bolted uses none."""
    near = [(math.hypot(pose.x - s.x, pose.y - s.y), n) for n, s in setup.lab.slots.items()]
    within = [(away, n) for away, n in near if away <= setup.lab.slots[n].capture]
    return min(within)[1] if within and setup.movable(name) else None


def mouth(slot: Slot) -> Base:
    """Return what must stay empty of all but the part in a slot."""
    return Base(Point(slot.x, slot.y), slot.capture)


def right(setup: Setup, wanted: LabState, name: str, pose: Pose) -> bool:
    """Whether a part at a pose is where it belongs."""
    slot, goal = place_of(setup, wanted, name)
    if slot:
        return pose.distance(goal) <= setup.lab.slots[slot].capture
    tolerance = setup.type_of(name).pose.tolerance
    away, turned = pose.distance(goal), abs((pose.yaw - goal.yaw + 180) % 360 - 180)
    return away <= tolerance.position + EPSILON and turned <= tolerance.yaw + EPSILON


class World:
    """What stands where, as a plan is walked that is to lead to a state."""

    def __init__(self, setup: Setup, seen: Observation, wanted: LabState) -> None:
        self.setup, self.wanted = setup, wanted
        self.poses: dict[str, Pose] = {
            n: p.pose for n, p in seen.components.items() if p.pose is not None and p.presence == "seen"
        }
        self.strangers = seen.unknown
        self._bases: dict[tuple[str, Pose], Base] = {}

    def base_of(self, name: str, pose: Pose) -> Base:
        key = (name, pose)
        if key not in self._bases:
            self._bases[key] = base(self.setup.type_of(name).geometry.footprint, pose)
        return self._bases[key]

    def others(self, name: str) -> Iterable[tuple[str, Base, float]]:
        """Yield name, base and height of everything that stands beside a component."""
        for other, pose in self.poses.items():
            if other != name:
                yield other, self.base_of(other, pose), self.setup.type_of(other).geometry.height
        for other, thing in self.strangers.items():
            yield other, base(thing.footprint, thing.pose), thing.height

    def place_faults(self, name: str, pose: Pose, slot: str | None) -> list[str]:
        """Return what keeps a component from standing at a pose."""
        lab, geometry = self.setup.lab, self.setup.type_of(name).geometry
        shape = self.base_of(name, pose)
        faults = [
            f"{name} at {pose} is {gap:.6f} mm from {other}"
            for other, standing, _ in self.others(name)
            if (gap := shape.gap(standing)) <= max(lab.margins.body - EPSILON, 0.0)
        ]
        gantries = all(robot.model == "gantry" for robot in lab.robots.values())
        faults += [] if slot and gantries else self._off_table(name, shape)
        for zone, keep_out in lab.keep_out.items():
            if keep_out.z[0] <= geometry.height and _zone(keep_out.area).gap(shape) <= 0:
                faults.append(f"{name} stands in keep-out {zone}")
        faults += self._covers(name, pose, shape)
        return faults + (self._slot_faults(name, pose, slot) if slot else [])

    def _off_table(self, name: str, shape: Base) -> list[str]:
        x0, y0, x1, y1 = shape.core.bounds
        r, (width, depth) = shape.radius, self.setup.lab.table.size
        inside = min(x0, y0) - r >= -EPSILON and x1 + r <= width + EPSILON and y1 + r <= depth + EPSILON
        return [] if inside else [f"{name} sticks out over the edge"]

    def _slot_faults(self, name: str, pose: Pose, slot: str) -> list[str]:
        place, footprint = self.setup.lab.slots[slot], self.setup.type_of(name).geometry.footprint
        faults = []
        if math.hypot(pose.x - place.x, pose.y - place.y) > EPSILON:
            faults.append(f"{name} is not put into the middle of {slot}")
        if abs(((pose.yaw - place.yaw + 45) % 90) - 45) > EPSILON:
            faults.append(f"{name} stands askew in {slot}")
        corners = footprint.polygon or _box_corners(*(footprint.box or (0.0, 0.0)))
        radius = footprint.disc or max(math.hypot(x, y) for x, y in corners)
        if place.fits is not None and radius > place.fits + EPSILON:
            faults.append(f"{name} does not fit into {slot}")
        faults += [
            f"{slot} is not free: {o} meets it" for o, b, _ in self.others(name) if mouth(place).gap(b) < -EPSILON
        ]  # fmt: skip
        return faults

    def _covers(self, name: str, pose: Pose, shape: Base) -> list[str]:
        """Return the slots in use that a part would cover: only where both belong it may."""
        faults = []
        for other, stands in self.poses.items():
            slot = slot_used(self.setup, other, stands) if other != name else None
            if slot is None or mouth(self.setup.lab.slots[slot]).gap(shape) >= -EPSILON:
                continue
            if not (right(self.setup, self.wanted, name, pose) and right(self.setup, self.wanted, other, stands)):
                faults.append(f"{name} at {pose} covers {slot}, in which {other} is")
        return faults

    def grip_faults(self, name: str, pose: Pose, yaw: float, robot: str, when: str) -> list[str]:
        """Return what the open fingers would touch."""
        lab, geometry = self.setup.lab, self.setup.type_of(name).geometry
        zones, lowest = fingers(geometry, lab.robots[robot].gripper, yaw, pose)
        enough = max(lab.margins.fingers - EPSILON, 0.0)
        faults = [
            f"fingers at {when} of {name} are {gap:.6f} mm from {other}"
            for other, standing, height in self.others(name)
            if height > lowest
            for zone in zones
            if (gap := zone.gap(standing)) <= enough
        ]
        for zone_name, keep_out in lab.keep_out.items():
            if keep_out.z[1] >= lowest and any(_zone(keep_out.area).gap(z) <= 0 for z in zones):
                faults.append(f"fingers at {when} of {name} reach into keep-out {zone_name}")
        return faults

    def walk(self, operation: Operation) -> list[str]:
        """Make one move, and return what was wrong with it."""
        if "to" not in operation.arguments or not isinstance(operation.arguments["to"], Mapping):
            return []
        name = operation.component
        start, goal = Pose(**operation.arguments["from"]["pose"]), Pose(**operation.arguments["to"]["pose"])
        now = self.poses.get(name)
        faults = []
        if now is None or now.distance(start) > EPSILON or abs(now.yaw - start.yaw) > EPSILON:
            faults.append(f"{operation.id} takes {name} from {start}, but it stands at {now}")
        if operation.primitive != "operator":
            faults += self._arm_faults(operation, start, goal)
        faults += self.place_faults(name, goal, operation.arguments["to"].get("slot"))
        self.poses[name] = goal
        return [f"{operation.id}: {f}" for f in faults]

    def _arm_faults(self, operation: Operation, start: Pose, goal: Pose) -> list[str]:
        name, yaw, robot = operation.component, operation.arguments["grasp_yaw"], operation.robot
        faults = []
        if not self.setup.movable(name):
            faults.append(f"{name} may not be moved by an arm")
        grasp = self.setup.type_of(name).geometry.grasp
        if grasp and not any(abs((yaw - y + 90) % 180 - 90) < EPSILON for y in grasp.yaws):
            faults.append(f"{name} can't be held at {yaw}")
        if robot not in self.setup.lab.robots:
            return [*faults, f"no robot {robot}"]
        faults += self.grip_faults(name, start, yaw, robot, "pick")
        return faults + self.grip_faults(name, goal, yaw, robot, "place")


def _zone(area: object) -> Base:
    (x0, x1), (y0, y1) = area.x, area.y  # type: ignore[attr-defined]
    return Base(Polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]))


def check(
    setup: Setup, seen: Observation, wanted: LabState, plan: Plan, *, seed: int = 0, extensions: int = 5
) -> list[str]:
    """Return everything that is wrong with a plan; `extensions`: how many other orders that keep `after` are walked."""
    operations = plan.operations
    faults = [*_graph_faults(operations), *_staging_faults(setup, wanted, operations)]
    world = World(setup, seen, wanted)
    for operation in operations:
        faults += world.walk(operation)
    faults += _end_faults(setup, seen, wanted, plan, world)
    rng = random.Random(seed)
    for _ in range(extensions if len(operations) > 1 else 0):
        faults += [f"in another order, {f}" for f in _walk(setup, seen, wanted, extension(operations, rng))]
        faults += [f"after a failure, {f}" for f in _walk(setup, seen, wanted, survivors(operations, rng))]
    return faults


def _walk(setup: Setup, seen: Observation, wanted: LabState, operations: Iterable[Operation]) -> list[str]:
    world = World(setup, seen, wanted)
    return [fault for operation in operations for fault in world.walk(operation)]


def extension(operations: Sequence[Operation], rng: random.Random) -> list[Operation]:
    """Return the operations in a random order that keeps `after`."""
    left, done, order = list(operations), set[str](), []
    while left:
        ready = [o for o in left if done.issuperset(o.after)]
        chosen = rng.choice(ready)
        left.remove(chosen)
        done.add(chosen.id)
        order.append(chosen)
    return order


def survivors(operations: Sequence[Operation], rng: random.Random) -> list[Operation]:
    """Return what is still done, in order, where one random operation fails and its dependents are skipped."""
    gone = {rng.choice(operations).id}
    kept = []
    for operation in operations:
        if operation.id in gone or gone.intersection(operation.after):
            gone.add(operation.id)
        else:
            kept.append(operation)
    return kept


def _graph_faults(operations: Sequence[Operation]) -> list[str]:
    faults, ends = [], dict[str, float]()
    for operation in operations:
        for earlier in operation.after:
            if earlier not in ends:
                faults.append(f"{operation.id} waits for {earlier}, which does not come before it")
            elif operation.start < ends[earlier] - 1e-5:
                faults.append(f"{operation.id} starts before {earlier} has ended")
        ends[operation.id] = operation.start + operation.seconds
    if sorted(operations, key=lambda o: o.start) != list(operations):
        faults.append("the operations are not sorted by start")
    for i, a in enumerate(operations):
        for b in operations[i + 1 :]:
            if set(a.resources) & set(b.resources) and b.start < a.start + a.seconds - 1e-5:
                faults.append(f"{a.id} and {b.id} use {set(a.resources) & set(b.resources)} at one time")
    return faults


def _staging_faults(setup: Setup, wanted: LabState, operations: Sequence[Operation]) -> list[str]:
    """Every place but a component's last is where it belongs or a storage slot, and no slot for one never staged."""
    faults = []
    last = {o.component: o.id for o in operations if o.primitive in ("move", "stow")}
    for operation in operations:
        if operation.primitive not in ("move", "stow") or last[operation.component] == operation.id:
            continue
        slot = operation.arguments["to"].get("slot")
        belongs, goal = place_of(setup, wanted, operation.component)
        pose = Pose(**operation.arguments["to"]["pose"])
        if slot == belongs and (slot or pose.distance(goal) < EPSILON):
            continue
        if slot is None:
            if not _in_staging_region(setup, operation.component, pose):
                faults.append(f"{operation.id} stages {operation.component} outside of storage")
            continue
        if setup.lab.inventory[operation.component].stage == "never":
            faults.append(f"{operation.id} stages {operation.component}, which is never staged")
    return faults


def _in_staging_region(setup: Setup, name: str, pose: Pose) -> bool:
    shape = base(setup.type_of(name).geometry.footprint, pose)
    (x0, y0, x1, y1), r = shape.core.bounds, shape.radius
    return any(
        region.staging and x0 - r >= region.area.x[0] - EPSILON and x1 + r <= region.area.x[1] + EPSILON
        and y0 - r >= region.area.y[0] - EPSILON and y1 + r <= region.area.y[1] + EPSILON
        for region in setup.lab.regions.values()
    )  # fmt: skip


def _end_faults(setup: Setup, seen: Observation, wanted: LabState, plan: Plan, world: World) -> list[str]:
    faults = []
    for name in setup.lab.inventory:
        if name not in world.poses:
            continue
        pose, (slot, goal) = world.poses[name], place_of(setup, wanted, name)
        if not right(setup, wanted, name, pose):
            faults.append(f"{name} ends at {pose}, not at {slot or goal}")
        values = wanted.components[name].values if name in wanted.components else {}
        for tunable, value in values.items():
            faults += _value_faults(setup, seen, plan, name, tunable, value)
    return faults


def _value_faults(setup: Setup, seen: Observation, plan: Plan, name: str, tunable: str, value: object) -> list[str]:
    live = seen.components[name].values.get(tunable)
    if live is None or setup.type_of(name).tunables[tunable].restore.kind == "none":
        return []
    now = None if live.status == "unknown" else live.value
    for operation in plan.operations:
        if (
            operation.component == name
            and operation.arguments.get("tunable") == tunable
            and "to" in operation.arguments
        ):
            now = operation.arguments["to"]
    if now == value:
        return []
    near = isinstance(now, int | float) and isinstance(value, int | float)
    kind = setup.type_of(name).tunables[tunable]
    if near and abs(math.remainder(now - value, kind.period or math.inf)) <= kind.tolerance + EPSILON:
        return []
    return [f"{name}.{tunable} ends at {now}, not at {value}"]
