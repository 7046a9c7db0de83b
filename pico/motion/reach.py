"""What can be said about a pick or a place without looking at collisions: pure Python, some 30 us a question."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pico.geometry import table as tabletop
from pico.geometry.shape import placed, separation
from pico.geometry.tethers import tether_fault
from pico.model.catalog import Geometry
from pico.model.lab import Lab
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.kinematics import reaches, span
from pico.motion.shapes import PALM_LENGTH
from pico.motion.types import Blocked

_BY_HAND = "let a person move it (`mover: person`)"


def opening(robot: Robot, geometry: Geometry) -> float:
    """Return the distance between the pads before they close on a part of `geometry`, and after they let go [mm]."""
    if robot.gripper.fingers == "none" or geometry.grasp is None:
        return 0.0
    return geometry.grasp.width + 2 * robot.gripper.fingers.opening


def grasp_height(robot: Robot, geometry: Geometry) -> float:
    """Return the height of the tool center point at which a part of `geometry` is held [mm]; a vacuum gripper holds
    it by its top. Raises ValueError for a part that nothing may hold."""
    if geometry.grasp is None:
        raise ValueError("the part has no grasp")
    return geometry.height if robot.gripper.fingers == "none" else geometry.grasp.height


def check_grip(name: str, robot: Robot, component: str, geometry: Geometry) -> Blocked | None:
    """Return why the gripper of the robot called `name` can't hold `component`, or None where it can."""
    gripper, grasp = robot.gripper, geometry.grasp
    if grasp is None:
        return Blocked("width", f"{component} has no place where a gripper may hold it", help=_BY_HAND)
    if gripper.fingers == "none":
        return None
    needed = opening(robot, geometry)
    if needed > gripper.stroke:
        text = (
            f"{component} is {grasp.width:.4g} mm wide where it is held; with {gripper.fingers.opening:.4g} mm to spare"
            f" on each side {name}'s gripper would have to open {needed:.4g} mm, it opens {gripper.stroke:.4g} mm"
        )
        return Blocked("width", text, by=needed - gripper.stroke, help=f"grasp it where it is narrower, or {_BY_HAND}")
    room = gripper.tool - PALM_LENGTH
    above = geometry.height - grasp.height
    if above > room:
        text = f"{component} stands {above:.4g} mm above where it is held; {name}'s fingers have room for {room:.4g} mm"
        return Blocked("width", text, by=above - room, help=f"grasp it higher, or {_BY_HAND}")
    return None


def height_needed(lab: Lab, robot: Robot, geometry: Geometry) -> float:
    """Return how high a robot must carry a part of `geometry` [mm, of its tool center point]: the part's foot is then
    off the table, and its open fingers are above the part that they have let go of."""
    fingers = robot.gripper.fingers
    if fingers == "none":
        return geometry.height + lab.margins.fingers
    return max(geometry.height, geometry.grasp.height if geometry.grasp else 0.0) + fingers.tip + lab.margins.fingers


def check_height(lab: Lab, name: str, component: str, geometry: Geometry) -> Blocked | None:
    """Return why the robot called `name` can't let go of `component` and leave it, or None where it can."""
    robot = lab.robots[name]
    needed = height_needed(lab, robot, geometry)
    if robot.transit_height >= needed - 1e-6:
        return None
    text = (
        f"{component} is {geometry.height:.4g} mm tall; to leave it {name} must rise to {needed:.4g} mm, and carries "
        f"at {robot.transit_height:.4g} mm"
    )
    higher = robot.model == "gantry" or span(robot, needed)[1] > 0
    raised = f"let {name} carry higher (`transit_height: {math.ceil(needed - 1e-6)}`), or {_BY_HAND}"
    return Blocked("height", text, by=needed - robot.transit_height, help=raised if higher else _BY_HAND)


def check_table(lab: Lab, component: str, geometry: Geometry, pose: Pose) -> Blocked | None:
    """Return why `component` can't stand at `pose`: over the table's edge, or in a keep-out zone."""
    shape = placed(geometry.footprint, pose)
    over = tabletop.overhang(lab.table, shape)
    if over > 1e-6:
        text = f"{component} at {pose} would stick out over the edge of the table by {over:.4g} mm"
        return Blocked("table_edge", text, obstacle="table", by=over, help=f"place it {over:.4g} mm farther in")
    for name, zone in lab.keep_out.items():
        gap = separation(shape, tabletop.outline(zone))
        if gap < 0 and tabletop.reaches(zone, 0.0, geometry.height):
            why = f" ({zone.reason})" if zone.reason else ""
            text = f"{component} at {pose} would stand {-gap:.4g} mm inside the keep-out zone {name}{why}"
            return Blocked(
                "keep_out", text, obstacle=name, by=-gap, help=f"place it {-gap:.4g} mm farther out of {name}"
            )
    return None


def check_tether(setup: Setup, component: str, pose: Pose) -> Blocked | None:
    """Return why the cable of `component` keeps it from `pose`, or None where it has none, or long enough."""
    text, by, hint = tether_fault(setup, component, pose)
    return Blocked("reach", f"{component} can't stand at {pose}: {text}", by=by, help=hint) if text else None


def check_reach(name: str, robot: Robot, component: str, geometry: Geometry, pose: Pose) -> Blocked | None:
    """Return why the arm can't hold its tool vertical over `pose` at the height of the grasp and of the transit, by the
    one of them that asks for more."""
    found = [
        _too_far(name, robot, component, pose, height)
        for height in (grasp_height(robot, geometry), robot.transit_height)
        if not reaches(robot, pose.x, pose.y, height)
    ]
    return max(found, key=lambda why: why.by or 0.0, default=None)


def out_of_reach(arms: Sequence[Robot], x: float, y: float, geometry: Geometry | None = None) -> str:
    """Return how far a place is from the nearest base, and what the arms reach, at the height at which they carry and
    at which they hold a part of `geometry` there; empty where one of them reaches it."""
    reach = [(arm.mount, *_bounds(arm, geometry)) for arm in arms]
    away = [math.hypot(x - mount.x, y - mount.y) for mount, _, _ in reach]
    if any(near <= d <= far for d, (_, near, far) in zip(away, reach, strict=True)):
        return ""
    bounds = " or ".join(sorted({f"{near:.0f} to {far:.0f} mm" for _, near, far in reach}))
    nearest, mount = min((d, f"({mount.x:g}, {mount.y:g})") for d, (mount, _, _) in zip(away, reach, strict=True))
    return f"it is {nearest:.0f} mm from the nearest base, at {mount}, and they reach {bounds}"


def _bounds(arm: Robot, geometry: Geometry | None) -> tuple[float, float]:
    low = [grasp_height(arm, geometry)] if geometry and geometry.grasp else []
    near, far = zip(*(span(arm, height) for height in (arm.transit_height, *low)), strict=True)
    return max(near), min(far)


def _too_far(name: str, robot: Robot, component: str, pose: Pose, height: float) -> Blocked:
    distance = math.hypot(pose.x - robot.mount.x, pose.y - robot.mount.y)
    least, greatest = span(robot, height)
    where = f"{component} at {pose} is {math.ceil(distance)} mm from {name}'s base"
    if greatest == 0.0:
        text = f"{name} can't hold its tool vertical at {height:.0f} mm height anywhere"
        return Blocked("reach", text, help="change the robot's transit_height or mount")
    base = f"{name}'s base, which stands at ({robot.mount.x:g}, {robot.mount.y:g}), or use another arm"
    nearer = f"nearer to {base}"
    if distance < greatest:
        text = f"{where}; it comes no nearer than {math.ceil(least)} mm at {height:.0f} mm height"
        # no number: so near to its base what the arm reaches may still be blocked by itself
        return Blocked("reach", text, by=least - distance, help=f"place it farther from {base}")
    text = f"{where}; it reaches {math.floor(greatest)} mm at {height:.0f} mm height"
    return Blocked("reach", text, by=distance - greatest, help=f"place it {math.ceil(distance - greatest)} mm {nearer}")
