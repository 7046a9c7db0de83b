"""The kinematic world: robots follow their paths exactly, and what they carry follows them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Generator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.attempt import Failed
from pico.backends.sim.mover import InProgress
from pico.backends.sim.world import World, put_down
from pico.geometry.seat import PlacementError, Seat, injected
from pico.model.observation import ObservedRobot, Presence
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.trace.learned import Learned
from pico.motion.kinematics import tool_of
from pico.motion.types import Joints, MovePath, Segment, Stage
from pico.twin.arms import arms_of
from pico.vision.arm import ArmOffsets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.backends.sim.sight import Posed
    from pico.cameras.simulated import Eyes

    Array = NDArray[np.float64]

STEP = 0.5
"""Seconds of a path that are walked in one go where nobody watches."""

BRAKE = 0.2
"""Seconds in which an arm that is stopped comes to rest."""


class KinematicWorld:
    """Moves robots and components of `world` without dynamics: what a perfect arm carries ends exactly at its goal,
    what another one does where that takes it, and where the lab asks for it, what the seat makes of that.

    `step`: seconds of a path that are walked in one go. `known`: how arms are off, as calibration found it;
    `learned`: how parts come to stand, as runs of the bench showed.
    """

    def __init__(
        self, setup: Setup, world: World, known: Mapping[str, ArmOffsets] | None = None, learned: Learned | None = None
    ) -> None:
        self._setup, self._known, self._start, self._learned = setup, known, world, learned
        self.step = STEP
        self._arms = {n: arm for n, arm in arms_of(setup, world.seed, known).items() if not arm.perfect}
        self._slack: dict[str, Array] = {}  # by how much motors are ahead of joints, of arms that are not perfect
        self._joints = {name: robot.joints for name, robot in world.robots.items()}
        self._held: dict[str, tuple[str, Pose]] = {}  # by robot: the component, and its pose seen from the tool
        for name, robot in world.robots.items():
            body = world.components.get(robot.holding or "")
            if robot.holding and body and body.pose:
                self._held[name] = (robot.holding, self._tool(name).inverse().compose(body.pose))
        self._stages: dict[str, Stage] = {}
        self._placed: dict[str, Pose] = {}  # what was put down since
        self._seats: dict[str, Seat] = {}  # and how it sits
        self._fallen: dict[str, Presence] = {}  # and what does not stand
        self._scene: Posed | None = None

    def advance(self, seconds: float) -> None:
        """Nothing happens between the moments at which operations are resumed."""

    def move(self, operation: Operation, path: MovePath, stands: Pose | None = None) -> InProgress:
        """Walk `path`: the component goes with the tool from the end of `grip` to that of `release`."""
        robot, goal = path.robot, Pose(**operation.arguments["to"]["pose"])
        start = Pose(**operation.arguments["from"]["pose"])
        for segment in path.segments:
            yield from self._walk(robot, segment)
            if segment.name == "grip":
                self._held[robot] = (operation.component, self._tool(robot).inverse().compose(start))
            elif segment.name == "release":
                self._put_down(operation.component, (robot in self._arms and self.carried(robot)) or goal)
                del self._held[robot]
                self._fallen.pop(operation.component, None)
        return {}

    def put(self, component: str, pose: Pose) -> None:
        """Let a person put a component down at a pose on the table."""
        self._put_down(component, pose)
        self._placed[component] = pose
        self._fallen.pop(component, None)

    def _put_down(self, name: str, goal: Pose) -> None:
        body = self._start.components[name]
        now = self._start.with_body(name, seat=self._seats.get(name, body.seat))
        errs = injected(self._setup, name, self._learned, 0.0)
        self._placed[name], seat = put_down(self._setup, now, name, goal, errs)
        if errs != PlacementError() or body.seat:
            self._seats[name] = seat

    def park(self, path: MovePath) -> InProgress:
        """Walk `path`."""
        for segment in path.segments:
            yield from self._walk(path.robot, segment)
        return {}

    def let_go(self, name: str, pose: Pose, presence: Presence) -> None:
        """Let a component be at `pose`, standing or not, and in no hand: what a hand does that loses it."""
        self._held = {robot: held for robot, held in self._held.items() if held[0] != name}
        self._placed[name], self._fallen[name] = pose, presence

    def stage(self, robot: str) -> Stage:
        """Return how far an arm is on its path."""
        return self._stages[robot]

    def eyes(self, world: World) -> Eyes:
        """Return the cameras, which look at `world` as it is now."""
        from pico.backends.sim.sight import Posed

        self._scene = self._scene or Posed(self._setup, world, self._known)
        return self._scene.eyes(world)

    def left(self, component: str) -> None:
        """No hand has an eye here: its fingers would hide nothing from it."""

    def carried(self, robot: str) -> Pose | None:
        """Return where the component in the gripper is, or None."""
        if robot not in self._held:
            return None
        return self._tool(robot).compose(self._held[robot][1])

    def world(self, world: World) -> World:
        """Return `world` as it is now."""
        components = dict(world.components)
        for name, pose in self._placed.items():
            presence = self._fallen.get(name, "seen")
            where = None if presence == "missing" else pose
            seat = self._seats.get(name, components[name].seat)
            components[name] = replace(components[name], presence=presence, pose=where, free=None, seat=seat)
        robots = {
            name: ObservedRobot(joints=joints, holding=self._held[name][0] if name in self._held else None)
            for name, joints in self._joints.items()
        }
        for robot, (name, _) in self._held.items():
            components[name] = replace(components[name], presence="held", pose=self.carried(robot), free=None)
        return replace(world, components=components, robots=robots, openings={})

    def _tool(self, robot: str) -> Pose:
        if robot in self._arms:
            return self._arms[robot].tool(self._joints[robot], self._slack.get(robot))
        return tool_of(self._setup.lab.robots[robot], self._joints[robot])

    def _brake(self, robot: str, segment: Segment, elapsed: float) -> Generator[float, None, None]:
        """Come to rest evenly: on the way by half of what the arm would have gone on."""
        if segment.name in ("grip", "release"):
            return
        yield BRAKE
        self._turn(robot, joints_at(segment, min(segment.seconds, elapsed + BRAKE / 2)))

    def _walk(self, robot: str, segment: Segment) -> Generator[float, None, None]:
        elapsed, self._stages[robot] = 0.0, Stage(segment.name)
        while elapsed < segment.seconds:
            step = min(self.step, segment.seconds - elapsed)
            try:
                yield step
            except Failed:
                yield from self._brake(robot, segment, elapsed)
                raise
            elapsed += step
            self._stages[robot] = Stage(segment.name, elapsed / segment.seconds)
            self._turn(robot, joints_at(segment, elapsed))
        self._turn(robot, segment.joints[-1])

    def _turn(self, robot: str, joints: Joints) -> None:
        """Let an arm have these joints from now on."""
        if robot in self._arms:
            self._slack[robot] = self._arms[robot].slack(self._joints[robot], joints, self._slack.get(robot))
        self._joints[robot] = joints


def joints_at(segment: Segment, seconds: float) -> Joints:
    """Return the joints [rad] of a segment `seconds` after its start, straight between its waypoints."""
    i = bisect_right(segment.times, seconds)
    if i == 0 or i == len(segment.times):
        return segment.joints[max(0, i - 1)]
    t0, t1 = segment.times[i - 1], segment.times[i]
    share = (seconds - t0) / (t1 - t0)
    return tuple(a + share * (b - a) for a, b in zip(segment.joints[i - 1], segment.joints[i], strict=True))
