"""Arms that stay where they stand, with a part in the hand or no way to their park pose: while one is where arms meet,
no other comes there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from pico.geometry import disc, polygon, separation
from pico.model.observation import Observation, astray
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.deferred import DeferredMotion
from pico.motion.types import Blocked, Joints, Motion, MovePath, StandingObject
from pico.motion.zones import HAND, MARGIN, Zone, enters, shared_zones, within
from pico.planning.parts.movers import standing_obstacles


@dataclass(frozen=True, slots=True)
class StandingArm:
    """An arm that stays in a zone, why, and what would let it leave."""

    robot: str
    zone: Zone
    why: str
    help: str

    @property
    def blocks(self) -> Blocked:
        """Why another arm can't come into the zone."""
        text = f"{self.robot} stays where arms meet: {self.why}"
        return Blocked("collision", text, obstacle=self.robot, help=self.help)


def beside_standing(setup: Setup, seen: Observation, motion: Motion | None) -> Motion | None:
    """Return how the arms move beside those that stay where arms meet: the same where none does, or nobody asks."""
    staying = tuple(_staying(setup, seen, motion)) if motion and len(setup.lab.robots) > 1 else ()
    return BesideStanding(setup, motion, staying) if motion and staying else motion


def _staying(setup: Setup, seen: Observation, motion: Motion) -> Iterator[StandingArm]:
    zones, why = shared_zones(setup), dict[str, tuple[str, str]]()
    for robot, state in seen.robots.items():
        if robot in setup.lab.robots and state.holding:
            help = f"take {state.holding} out of its gripper by hand, then plan again"
            why[robot] = f"it holds {state.holding} and can't set it down", help
    for robot in astray(setup, seen):
        if blocked := _shut_in(setup, seen, robot, motion):
            help = blocked.help or f"move {robot} to its park pose by hand, then plan again"
            why[robot] = f"it was stopped there and can't park, as {blocked.text}", help
    for robot, (text, help) in sorted(why.items()):
        joints = seen.robots[robot].joints
        if joints or setup.lab.robots[robot].model != "xarm7":
            inside = (z for z in zones if robot in z.robots and within(setup, z, robot, joints, margin=MARGIN))
            yield from (StandingArm(robot, zone, text, help) for zone in inside)


def _shut_in(setup: Setup, seen: Observation, robot: str, motion: Motion) -> Blocked | None:
    """Return why an arm has no way to its park pose even where all that an arm may move is gone; None where it has."""
    moving = {
        n for n, c in seen.components.items() if n in setup.lab.inventory and setup.movable(n) and c.presence == "seen"
    }
    standing = {o.name: o.standing for o in standing_obstacles(setup, seen, moving)}
    found = motion.park(robot, seen.robots[robot].joints, standing)
    return found if isinstance(found, Blocked) else None


class BesideStanding(DeferredMotion):
    """How the arms of a bench move beside those that stay where arms meet."""

    def __init__(self, setup: Setup, arms: Motion, staying: tuple[StandingArm, ...]) -> None:
        super().__init__(setup, arms)
        self._staying = staying

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        """See `Motion.reach`."""
        hand = disc(pose.x, pose.y, HAND)
        barred = (a.blocks for a in self._beside(robot) if separation(hand, polygon(a.zone.corners)) <= MARGIN)
        own = (a.blocks for a in self._staying if a.robot == robot)
        return super().reach(robot, component, pose, grasp_yaw) or next(own, None) or next(barred, None)

    def move(
        self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float,
        standing: Mapping[str, StandingObject], joints: Joints | None = None,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.move`."""
        return self._clear(super().move(robot, component, start, goal, grasp_yaw, standing, joints, others))

    def park(
        self, robot: str, joints: Joints, standing: Mapping[str, StandingObject],
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.park`."""
        return self._clear(super().park(robot, joints, standing, others))

    def _beside(self, robot: str) -> Iterator[StandingArm]:
        return (arm for arm in self._staying if robot in arm.zone.robots and robot != arm.robot)

    def _clear(self, found: MovePath | Blocked) -> MovePath | Blocked:
        """Return a path as it is where it keeps out of the zones in which an arm stays."""
        if isinstance(found, Blocked):
            return found
        inside = (a.blocks for a in self._beside(found.robot) if enters(self._setup, a.zone, found, MARGIN))
        return next(inside, found)
