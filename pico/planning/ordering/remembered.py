"""The arms of a bench, asked once: while a plan is sought the same path is asked for again and again."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any, cast

from pico.model.pose import Pose
from pico.motion.types import Blocked, Joints, Motion, MovePath, StandingObject


def remembered(arms: Motion) -> Motion:
    """Return the same arms, which give the answers that they gave before without looking again."""
    return cast(Motion, _Remembered(arms))


class _Remembered:
    def __init__(self, arms: Motion) -> None:
        self._arms = arms
        self._known: dict[Hashable, MovePath | Blocked] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._arms, name)

    def move(
        self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float,
        standing: Mapping[str, StandingObject], joints: Joints | None = None,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.move`."""
        key = (robot, component, start, goal, grasp_yaw, _world(standing), joints, _arms(others))
        if key not in self._known:
            more = (others,) if others is not None else ()
            self._known[key] = self._arms.move(robot, component, start, goal, grasp_yaw, standing, joints, *more)
        return self._known[key]

    def park(
        self, robot: str, joints: Joints, standing: Mapping[str, StandingObject],
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.park`."""
        key = (robot, joints, _world(standing), _arms(others))
        if key not in self._known:
            more = (others,) if others is not None else ()
            self._known[key] = self._arms.park(robot, joints, standing, *more)
        return self._known[key]


def _world(standing: Mapping[str, StandingObject]) -> Hashable:
    """What stands where; geometries are those of a catalog, which lives longer than the answers."""
    return frozenset((name, o.pose, id(o.geometry)) for name, o in standing.items())


def _arms(others: Mapping[str, Joints] | None) -> Hashable:
    return frozenset(others.items()) if others is not None else None
