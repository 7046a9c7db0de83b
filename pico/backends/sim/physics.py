"""The physical world: the simulated table in MuJoCo, where parts are carried by friction and can be dropped."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.attempt import Failed
from pico.backends.sim.bodies import body_placement
from pico.backends.sim.mover import InProgress
from pico.backends.sim.world import FreePose, World, WorldBody, put_down
from pico.diagnostics import error
from pico.geometry.seat import Seat, injected
from pico.model.catalog import Geometry
from pico.model.observation import ObservedRobot, Presence
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.model.trace.learned import Learned
from pico.motion.types import MovePath, Stage
from pico.twin.arms import arms_of
from pico.twin.gestures import walk
from pico.twin.handling import Handling, Lost
from pico.twin.physics import Twin
from pico.twin.placement import Placement, upright
from pico.twin.scene import SceneBody
from pico.twin.sight import Exact, HandSight, InHand
from pico.vision.arm import ArmOffsets

if TYPE_CHECKING:
    from pico.cameras.simulated import Eyes

TOPPLED = 5.0
"""A part that leans more than this does not stand [deg]."""
FALLEN = -20.0
"""A part whose base is lower than this has left the table [mm]."""
LEANS, RAISED = 0.3, 0.3
"""A part that stands is stored upright and on the table where it leans or is raised by less [deg, mm]."""
OFF_PLANE = 3.0
"""A part whose base is farther from the table than this does not stand on it [mm]."""
HELD_ABOVE = 0.2
"""A part between the pads is held where its base is higher than this [mm]; below, it stands."""
SAME = 1e-4
"""Poses that differ by less are the same [mm, deg]: a part that nobody touched keeps the pose that was stored."""


class PhysicsWorld:
    """Moves robots and components of `world` in the twin; implements `Mover`.

    `friction`: sliding friction coefficient of the finger pads; the lab's where None. `sight` makes what sees a part
    in the hand of the twin; None places blindly. `known`: how arms are off, as calibration found it; `learned`: how
    parts come to rest in their seats, as runs of the bench showed.
    """

    def __init__(
        self,
        setup: Setup,
        world: World,
        *,
        friction: float | None = None,
        sight: Callable[[Twin], HandSight] | None = Exact,
        known: Mapping[str, ArmOffsets] | None = None,
        learned: Learned | None = None,
    ) -> None:
        self._setup, self._learned = setup, learned
        self._start, self._seats = world, dict[str, Seat]()
        places = {name: place for name in world.components if (place := body_placement(setup, world, name))}
        things = {n: SceneBody(setup.type_of(n).geometry, p, setup.loose(n)) for n, p in places.items()}
        self._own = tuple(things)
        for name, stranger in world.unknown.items():
            shape = Geometry(footprint=stranger.footprint, height=stranger.height, mass=1.0)
            things[name] = SceneBody(shape, upright(stranger.pose))
        joints = {name: robot.joints for name, robot in world.robots.items()}
        holding = {name: robot.holding for name, robot in world.robots.items() if robot.holding}
        arms = arms_of(setup, world.seed, known)
        magnets = {n for n in things if n in setup.lab.inventory and setup.seating_of(n) in ("magnet", "kinematic")}
        self.twin = Twin(
            setup, things, joints, world.openings, holding=holding, pad_friction=friction, arms=arms, magnets=magnets
        )
        self._sight = sight(self.twin) if sight else None
        self._eyes: Eyes | None = None
        self._left: dict[str, InHand | None] = {}

    def advance(self, seconds: float) -> None:
        """Let `seconds` pass for all operations in progress."""
        self.twin.advance(seconds)

    def move(self, operation: Operation, path: MovePath, stands: Pose | None = None) -> InProgress:
        """Pick `operation.component`, carry and place it along `path`; see `Handling.run` for what is returned.

        Raises Failed where the part was missed, dropped or toppled: then the hand is open and above the table.
        """
        self._require_fingers(path.robot)
        name, goal = operation.component, Pose(**operation.arguments["to"]["pose"])
        if name not in self._own:
            text = f"{name} is not on the table, nor in the hand of {path.robot}: somebody took it"
            hint = "put it back; `pico recover --fidelity kinematic` parks the arm"
            raise Failed(error("missing", text, hint=hint, address=name))
        grasp, robot = self._setup.type_of(name).geometry.grasp, self._setup.lab.robots[path.robot]
        assert grasp is not None  # else it has no path
        handling = Handling(self.twin, robot, name, grasp, path, goal, self._sight, stands, self._seat)
        self._left.pop(name, None)
        lets_go = any(segment.name == "release" for segment in path.segments)
        work = handling.run() if lets_go else handling.carry()
        found: dict[str, Any] = yield from self._guarded(path.robot, work)
        self._left[name] = handling.left
        return found

    def park(self, path: MovePath) -> InProgress:
        """Bring `path.robot` along `path`, its gripper as it is, or open where it was stopped while it closed."""
        self._require_fingers(path.robot)
        if self.twin.opening(path.robot) < path.segments[0].opening:
            self.twin.grip(path.robot, path.segments[0].opening)
        yield from self._guarded(path.robot, walk(self.twin, path.robot, path.segments))
        return {}

    def put(self, component: str, pose: Pose) -> None:
        """Let a person put a component down at a pose on the table."""
        stands = self.twin.placement(component).pose
        turn = angle_between(stands.yaw, pose.yaw)
        self.twin.pull(component, pose.x - stands.x, pose.y - stands.y, turn)

    def stage(self, robot: str) -> Stage:
        """Return how far an arm is on its path."""
        return self.twin.stages[robot]

    def eyes(self, world: World) -> Eyes:
        """Return the cameras, which look at the twin as it is now."""
        from pico.backends.sim.cameras import eyes_of

        self._eyes = self._eyes or eyes_of(self._setup, world, self.twin.model, self.twin.data)
        return self._eyes

    def left(self, component: str) -> InHand | None:
        """Return where the eye in a hand saw a component when the hand let go of it; None where none did."""
        return self._left.get(component)

    def carried(self, robot: str) -> Pose | None:
        """Return where the component in the gripper of `robot` is, seen from above, or None where it holds none."""
        held = self._held(robot)
        return self.twin.placement(held).pose if held else None

    def world(self, world: World) -> World:
        """Return `world` with poses, presence, joints and what is held as they are now."""
        held = {name: self._held(name) for name in world.robots}
        components = dict(world.components)
        for name in self._own:
            body = replace(components[name], seat=self._seats.get(name, components[name].seat))
            components[name] = _seen(body, self.twin.placement(name), name in held.values())
        robots = {
            name: ObservedRobot(joints=self.twin.joints(name), holding=held[name]) if name in self.twin.arms else robot
            for name, robot in world.robots.items()
        }
        openings = {name: self.twin.opening(name) for name in self.twin.arms}
        return replace(world, components=components, robots=robots, openings=openings)

    def _seat(self, component: str) -> None:
        """A seat takes hold of a part that was let go: it comes to rest within the repeatability of its type. A free
        part stays where it stands, but leans as it may."""
        here, errs = Pose(0.0, 0.0), injected(self._setup, component, self._learned, 1.0)
        now = self._start.with_body(component, seat=self._seats.get(component, self._start.components[component].seat))
        off, seat = put_down(self._setup, now, component, here, errs)
        self._seats[component] = seat
        if self._setup.seating_of(component) in ("magnet", "kinematic"):
            self.twin.pull(component, off.x, off.y, off.yaw)

    def _guarded(self, robot: str, work: Generator[float, None, Any]) -> Generator[float, None, Any]:
        """Do `work`; where it fails or is stopped, the arm stops where it is."""
        try:
            return (yield from work)
        except Lost as lost:
            raise Failed(lost.diagnostic) from lost
        except (Failed, GeneratorExit):
            self.twin.hold(robot)
            raise

    def _held(self, robot: str) -> str | None:
        name = self.twin.gripped(robot) if robot in self.twin.arms else None
        return name if name and self.twin.placement(name).position[2] * 1000 > HELD_ABOVE else None

    def _require_fingers(self, robot: str) -> None:
        settings = self._setup.lab.robots[robot]
        if settings.model == "xarm7" and settings.gripper.fingers != "none":
            return
        text = f"physics has no model of {robot}: it knows the xArm7 with fingers only"
        raise Failed(error("not-simulated", text, hint="use `--fidelity kinematic`"))


def seeing(setup: Setup, world: World, root: Path) -> Callable[[Twin], HandSight] | None:
    """Return what makes the sight that the lab asks for: `sim.sight`.

    The eyes trust the calibration in the folder `root`, and what the lab says of its cameras where there is none.
    """
    sight = setup.lab.sim.hand_sight
    if sight != "pixels":
        return Exact if sight == "exact" else None

    def eyes(twin: Twin) -> HandSight:
        from pico.backends.sim.cameras import eyes_of
        from pico.cameras.eye_in_hand import EyeInHand
        from pico.vision.calibration_files import SIMULATED, read_calibration
        from pico.vision.nominal import camera_models

        found = read_calibration(root, SIMULATED)
        trusted = camera_models(setup) | dict(found.cameras if found else {})
        seen = eyes_of(setup, world, twin.model, twin.data)
        return EyeInHand(setup, twin, seen, trusted, found.accuracy if found else None, found.arms if found else None)

    return eyes


def _seen(body: WorldBody, placement: Placement, held: bool) -> WorldBody:
    """The component as it is now."""
    x, y, z = (v * 1000 for v in placement.position)
    if z < FALLEN:
        return replace(body, presence="missing", pose=None, free=None)
    pose = placement.pose
    free = FreePose(position=(x, y, z), quaternion=placement.quaternion)
    if not held and placement.tilt <= TOPPLED and abs(z) <= OFF_PLANE:
        flat = placement.tilt < LEANS and abs(z) < RAISED
        return replace(body, presence="seen", pose=_kept(body, pose), free=None if flat else free)
    presence: Presence = "held" if held else "toppled"
    return replace(body, presence=presence, pose=pose, free=free)


def _kept(body: WorldBody, pose: Pose) -> Pose:
    """The pose that was stored where the part has not moved, else the new one."""
    old = body.pose
    if old is None or body.free is not None or not math.isfinite(pose.x):
        return pose
    same = pose.distance(old) < SAME and abs(angle_between(pose.yaw, old.yaw)) < SAME
    return old if same else pose
