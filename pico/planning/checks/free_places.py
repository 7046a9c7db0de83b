"""Where a part may stand instead: free beside everything else, and an arm brings it there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

from pico.geometry import Shape, capture_disc, conflict, finger_height, finger_zones, fits, outline, reaches
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.reach import out_of_reach
from pico.motion.types import Blocked, Motion, MovePath, StandingObject
from pico.planning.checks.standing import Standing, goal_shape, in_bounds
from pico.planning.parts.movers import Hold, Mover, Obstacle, Place, turned

WAYS = (
    (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0),
    *((math.cos(math.radians(15 * n)), math.sin(math.radians(15 * n))) for n in range(24) if n % 6),
)  # fmt: skip
"""Directions in which a free place is looked for: along x and y first, then every 15 degrees."""


TRIES = 40
"""Paths asked for in all for the places that one refusal offers."""
APART = 15.0
"""Where there is no path, the next place that is tried is so far away [mm]."""


@dataclass(slots=True)
class Trial:
    """Whether arms bring parts to places that might be offered, as a plan would: each of `worlds` is what may stand
    there meanwhile. Without `motion` nobody asks; `left`: how many paths may still be asked for."""

    motion: Motion | None
    worlds: Sequence[Mapping[str, StandingObject]]
    left: int = TRIES

    def kept(self, mover: Mover) -> Blocked | None:
        """Return why nobody picks a part up where it stands; None where somebody does."""
        here, blocked = mover.start.pose, None
        for hold in mover.holds:
            if not self.motion or not hold.robot:
                return None
            blocked = self.motion.reach(hold.robot, mover.name, here, hold.yaw)
            if blocked is None:
                return None
        return blocked

    def brings(self, mover: Mover, holds: Sequence[Hold], pose: Pose) -> bool:
        """Whether an arm brings a part from where it stands to a pose in one of these holds, and parks; a person
        does."""
        return any(self._brings(mover, hold, pose, world) for hold in holds for world in self.worlds)

    def _brings(self, mover: Mover, hold: Hold, pose: Pose, world: Mapping[str, StandingObject]) -> bool:
        motion, robot, name, here = self.motion, hold.robot, mover.name, mover.start.pose
        if not motion or not robot:
            return True
        if any(motion.reach(robot, name, at, hold.yaw) for at in (here, pose)) or self.left <= 0:
            return False
        self.left -= 1
        path = motion.move(robot, name, here, pose, hold.yaw, {**world, name: StandingObject(here, mover.geometry)})
        if not isinstance(path, MovePath):
            return False
        after = {**world, name: StandingObject(pose, mover.geometry)}
        return isinstance(motion.park(robot, path.end, after), MovePath)


def trial_of(movers: Sequence[Mover], obstacles: Sequence[Obstacle], motion: Motion | None) -> Trial:
    """Return how places for these movers are tried: beside the others where they are to stand, or where they do."""
    stays = {o.name: o.standing for o in obstacles}
    ends = stays | {m.name: StandingObject(m.goal.pose, m.geometry) for m in movers}
    starts = stays | {m.name: StandingObject(m.start.pose, m.geometry) for m in movers}
    return Trial(motion, [ends, starts] if len(movers) > 1 else [starts])


def free_slots(setup: Setup, mover: Mover, standing: Standing, trial: Trial) -> list[str]:
    """Return the nearest slots that take a mover, where it would touch nothing and an arm brings it, three at most."""
    slots, footprint, goal = setup.lab.slots, mover.geometry.footprint, mover.goal.pose
    near = sorted(slots, key=lambda name: (slots[name].pose.distance(goal), name))
    return list(islice((
        name for name in near
        if fits(slots[name], footprint) and not standing.near(mover, capture_disc(slots[name]), 0.0)
        and any(
            _free(setup, mover, place, standing) and _offered(setup, mover, place, standing, trial)
            for place in turned(setup, name, footprint)
        )
    ), 3))  # fmt: skip


def nearest_free(setup: Setup, mover: Mover, standing: Standing, trial: Trial) -> tuple[float, float] | None:
    """Return the nearest free place (x, y) for a mover [mm], where fingers have room around it and an arm brings it,
    looked for in every direction of `WAYS` in steps of 1 mm, in whole mm where it is not beside the goal; along x wins
    a tie. None where none is found on the table."""
    pose, tried = mover.goal.pose, list[tuple[float, float]]()
    for step in range(1, int(max(setup.lab.table.size)) + 1):
        for east, north in WAYS:
            x = round(pose.x + step * east) if east else pose.x
            y = round(pose.y + step * north) if north else pose.y
            if any(math.hypot(x - a, y - b) < APART for a, b in tried):
                continue
            place = Place(Pose(x, y, pose.yaw))
            if _free(setup, mover, place, standing):
                if _offered(setup, mover, place, standing, trial):
                    return float(x), float(y)
                tried.append((x, y))
        if trial.left <= 0:
            return None
    return None


def _offered(setup: Setup, mover: Mover, place: Place, standing: Standing, trial: Trial) -> bool:
    """Whether an arm brings a mover to a place that is free, or a person does."""
    holds = [hold for hold in mover.holds if _gripped(setup, mover, hold, place.pose, standing)]
    return not mover.holds or trial.brings(mover, holds, place.pose)


def _free(setup: Setup, mover: Mover, place: Place, standing: Standing) -> bool:
    """Whether a mover may stand at a place beside everything else, and a hand that may move it gets there."""
    shape = goal_shape(mover, place)
    if not in_bounds(setup, mover, place) or standing.near(mover, shape, setup.lab.margins.body):
        return False
    if not _reached(setup, mover, shape):
        return False
    return not mover.holds or any(_gripped(setup, mover, hold, place.pose, standing) for hold in mover.holds)


def _gripped(setup: Setup, mover: Mover, hold: Hold, pose: Pose, standing: Standing) -> bool:
    """Whether the fingers of a hold have room around a mover beside everything else."""
    grasp, lab = mover.geometry.grasp, setup.lab
    if hold.robot is None or grasp is None:
        return True
    gripper = lab.robots[hold.robot].gripper
    lowest = finger_height(grasp, gripper)
    for zone in finger_zones(grasp, gripper, hold.yaw, pose):
        if any(other.height > lowest for other in standing.near(mover, zone, lab.margins.fingers)):
            return False
        if any(reaches(k, lowest, math.inf) and conflict(zone, outline(k)) for k in lab.keep_out.values()):
            return False
    return True


def _reached(setup: Setup, mover: Mover, shape: Shape) -> bool:
    """Whether a hand that may move it gets there."""
    robots = [setup.lab.robots[hold.robot] for hold in mover.holds if hold.robot]
    if len(robots) < len(mover.holds) or any(robot.model != "xarm7" for robot in robots):
        return True
    return not out_of_reach(robots, shape.x, shape.y, mover.geometry)
