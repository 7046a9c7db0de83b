"""The arms of a bench, loaded when something must move: a plan without moves then stays quick."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.types import Blocked, Joints, Motion, MovePath, StandingObject, Waypoint


class DeferredMotion:
    """A `Motion` that makes the real one at the first question."""

    def __init__(self, setup: Setup, arms: Motion | None = None) -> None:
        """`arms`: these instead of new ones."""
        self._setup, self._given = setup, arms

    @cached_property
    def _arms(self) -> Motion:
        if self._given is not None:
            return self._given
        from pico.motion.arms import ArmMotion

        return ArmMotion(self._setup)

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        """See `Motion.reach`."""
        return self._arms.reach(robot, component, pose, grasp_yaw)

    def move(
        self,
        robot: str,
        component: str,
        start: Pose,
        goal: Pose,
        grasp_yaw: float,
        standing: Mapping[str, StandingObject],
        joints: Joints | None = None,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.move`."""
        return self._arms.move(robot, component, start, goal, grasp_yaw, standing, joints, others)

    def set_down(
        self,
        robot: str,
        component: str,
        held: Pose,
        goal: Pose,
        standing: Mapping[str, StandingObject],
        joints: Joints,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.set_down`."""
        return self._arms.set_down(robot, component, held, goal, standing, joints, others)

    def park(
        self,
        robot: str,
        joints: Joints,
        standing: Mapping[str, StandingObject],
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.park`."""
        return self._arms.park(robot, joints, standing, others)

    def take(
        self, robot: str, component: str, start: Pose, grasp_yaw: float, standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.take`."""
        return self._arms.take(robot, component, start, grasp_yaw, standing, joints, others)

    def shift(
        self, robot: str, component: str, held: Pose, goal: Pose, standing: Mapping[str, StandingObject],
        joints: Joints, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.shift`."""
        return self._arms.shift(robot, component, held, goal, standing, joints, others)

    def let_go(
        self, robot: str, component: str, held: Pose, standing: Mapping[str, StandingObject], joints: Joints,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.let_go`."""
        return self._arms.let_go(robot, component, held, standing, joints, others)

    def use(
        self, robot: str, tool: str, start: Pose, points: Sequence[Waypoint], standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> tuple[MovePath, ...] | Blocked:  # fmt: skip
        """See `Motion.use`."""
        return self._arms.use(robot, tool, start, points, standing, joints, others)

    def travel(
        self,
        robot: str,
        start: Pose | Joints | None,
        goal: Pose | None,
        start_yaw: float = 0.0,
        goal_yaw: float = 0.0,
    ) -> float:
        """See `Motion.travel`."""
        return self._arms.travel(robot, start, goal, start_yaw, goal_yaw)

    def carry(self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float) -> float:
        """See `Motion.carry`."""
        return self._arms.carry(robot, component, start, goal, grasp_yaw)
