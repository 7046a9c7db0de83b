"""What comes too near to what where a plan puts it, recomputed from a plan alone: bases, slots, fingers. mm."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from pico.geometry import Shape, capture_disc, conflict, finger_height, finger_zones, placed, separation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.record import record
from pico.model.setup import Setup


@record
class Contact:
    """Something that stands too near. `overlap`: how deep it reaches in [mm]; negative: the gap that is left, which
    is less than the margin that must stay free."""

    kind: Literal["base", "slot", "finger"]
    overlap: float
    margin: float

    @property
    def text(self) -> str:
        """`their bases would overlap by 35 mm`, `a finger of the gripper would be only 1 mm from it, and ...`."""
        if self.kind == "slot":
            return f"it would stand {max(self.overlap, 0.0):.3g} mm inside the mouth of the slot"
        who, other = ("their bases", "apart") if self.kind == "base" else ("a finger of the gripper", "from it")
        it = "" if self.kind == "base" else " it"
        if self.overlap > 0:
            return f"{who} would overlap{it} by {self.overlap:.3g} mm"
        if self.overlap > -1e-3:
            return f"{who} would touch{it}"
        return f"{who} would be only {-self.overlap:.3g} mm {other}, and {self.margin:g} mm must stay free"


def footprint_at(setup: Setup, name: str, pose: Pose) -> Shape:
    """Return the footprint of a component of the inventory at a pose."""
    return placed(setup.type_of(name).geometry.footprint, pose)


def _contact(kind: Literal["base", "slot", "finger"], a: Shape, b: Shape, margin: float) -> Contact | None:
    if not conflict(a, b, margin):
        return None
    return Contact(kind=kind, overlap=round(-separation(a, b), 3), margin=margin)


def bases(setup: Setup, a: str, at: Pose, b: str, other: Pose) -> Contact | None:
    """Return how component `a` at one pose is too near to `b` at another, or None where there is room."""
    return _contact("base", footprint_at(setup, a, at), footprint_at(setup, b, other), setup.lab.margins.body)


def mouth(setup: Setup, slot: str | None, b: str, other: Pose) -> Contact | None:
    """Return how `b` keeps a slot from being empty, or None."""
    if slot is None or slot not in setup.lab.slots:
        return None
    return _contact("slot", capture_disc(setup.lab.slots[slot]), footprint_at(setup, b, other), 0.0)


def fingers(setup: Setup, robot: str | None, yaw: float, a: str, at: Pose, b: str, other: Pose) -> Contact | None:
    """Return how the fingers that pick or place `a`, closing along `yaw` [deg] in its frame, come too near to `b`;
    None where there is room, or `b` is no taller than the fingers reach down."""
    grasp = setup.type_of(a).geometry.grasp
    if robot is None or grasp is None or robot not in setup.lab.robots:
        return None
    gripper = setup.lab.robots[robot].gripper
    if setup.type_of(b).geometry.height <= finger_height(grasp, gripper):
        return None
    shape, margin = footprint_at(setup, b, other), setup.lab.margins.fingers
    zones = finger_zones(grasp, gripper, yaw, at)
    found = [c for zone in zones if (c := _contact("finger", zone, shape, margin))]
    return max(found, key=lambda c: c.overlap, default=None)


def holds(setup: Setup, name: str) -> Iterator[tuple[str, float]]:
    """Yield every robot with every direction [deg] in which its jaws may close on a component."""
    grasp = setup.type_of(name).geometry.grasp
    for robot in sorted(setup.lab.robots):
        for yaw in grasp.yaws if grasp else ():
            yield robot, yaw


@record
class Spot:
    """A pose, and the slot that it belongs to, if any."""

    pose: Pose
    slot: str | None = None

    def __str__(self) -> str:
        return self.slot or str(self.pose)


def spot_of(setup: Setup, where: object) -> Spot | None:
    """Return a place as a change, an operation or a state holds it: a slot's name, a pose, or both in a mapping."""
    if isinstance(where, str):
        return Spot(pose=setup.lab.slots[where].pose, slot=where) if where in setup.lab.slots else None
    if not isinstance(where, dict):
        return None
    if "x" in where and "y" in where:
        return Spot(pose=Pose(where["x"], where["y"], where.get("yaw", 0.0)))
    slot, pose = spot_of(setup, where.get("slot")), spot_of(setup, where.get("pose"))
    if slot and pose:
        return Spot(pose=pose.pose, slot=slot.slot)
    return pose or slot


def starts_of(setup: Setup, plan: Plan) -> dict[str, Spot]:
    """Return where each component stood when the plan was made: exactly where an operation picks it up, else as its
    base state says."""
    found = {}
    for name, state in plan.base.state.items():
        if name in setup.lab.inventory and (spot := spot_of(setup, dict(state)) or _fixed(setup, name)):
            found[name] = spot
    for change in plan.changes:
        if change.tunable == "pose" and (spot := spot_of(setup, change.before)):
            found[change.component] = spot
    for operation in reversed(plan.operations):
        if "from" in operation.arguments and (spot := spot_of(setup, operation.arguments["from"])):
            found[operation.component] = spot
    return found


def _fixed(setup: Setup, name: str) -> Spot | None:
    pose = setup.lab.inventory[name].pose
    return Spot(pose=pose) if pose else None


def ends_of(setup: Setup, plan: Plan) -> dict[str, Spot]:
    """Return where each component is to stand in the end: where the last of its moves puts it, else where the state
    wants it, else where it stands."""
    found = starts_of(setup, plan)
    for change in plan.changes:
        if change.tunable == "pose" and not change.tolerated and (spot := spot_of(setup, change.after)):
            found[change.component] = spot
    for operation in plan.operations:
        if spot := spot_of(setup, operation.arguments.get("to")):
            found[operation.component] = spot
    return found
