"""What the planner asks of an arm, and what it gets: a timed path, or what is in the way. Joints in radians."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from pico.model.catalog import Geometry
from pico.model.pose import Pose

Joints = tuple[float, ...]
"""Joint angles from the base outward [rad]."""

SegmentName = Literal["approach", "descend", "grip", "lift", "transit", "lower", "release", "retreat", "park"]


@dataclass(frozen=True, slots=True)
class StandingObject:
    """Something that stands on the table: where, and its shape."""

    pose: Pose
    geometry: Geometry


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A place over which the tool is brought at transit height, and lowered: its `pose` seen from above, how far above
    the table its base then is (`height`, mm); there it is turned by `turn` [deg], counter-clockwise from above, and
    lifted again."""

    pose: Pose
    height: float
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class Segment:
    """One leg of a path: joint waypoints with their times [s] from the segment's start, the first at 0.

    `opening` is the distance between the pads at its end [mm]; `grip` and `release` hold the joints still.
    """

    name: SegmentName
    times: tuple[float, ...]
    joints: tuple[Joints, ...]
    opening: float

    @property
    def seconds(self) -> float:
        return self.times[-1]

    @property
    def moving(self) -> Segment:
        """The segment without the time at its end in which the arm stands still."""
        if len(self.joints) < 3 or self.joints[-1] != self.joints[-2]:
            return self
        return Segment(self.name, self.times[:-1], self.joints[:-1], self.opening)


@dataclass(frozen=True, slots=True)
class Stage:
    """How far an arm is on a path: the segment that it executes, and which share of it is done (0 to 1)."""

    segment: SegmentName
    share: float = 0.0


@dataclass(frozen=True, slots=True)
class MovePath:
    """A collision-free motion of one robot, picking and placing one component (or none, for a park)."""

    robot: str
    component: str | None
    segments: tuple[Segment, ...]

    @property
    def seconds(self) -> float:
        return sum(s.seconds for s in self.segments)

    @property
    def hands_over(self) -> bool:
        """Whether the hand takes or lets go of the component on it."""
        return any(segment.name in ("grip", "release") for segment in self.segments)

    def gone(self, stage: Stage) -> float:
        """Return how many of its seconds are over where an arm is at `stage` of it."""
        names = [segment.name for segment in self.segments]
        if stage.segment not in names:  # the hand only rises, after the part was lost
            return self.seconds
        now = names.index(stage.segment)
        return sum(s.seconds for s in self.segments[:now]) + stage.share * self.segments[now].seconds

    @property
    def end(self) -> Joints:
        """Where the arm stands afterwards."""
        return self.segments[-1].joints[-1]


@dataclass(frozen=True, slots=True)
class Blocked:
    """Why a motion is not possible: `obstacle` names the component, robot part, keep-out zone or `table` that is hit
    in `segment`, `by` how deep [mm] where known; a `reach` has no obstacle. `help` is what might let it pass."""

    kind: Literal["reach", "collision", "keep_out", "table_edge", "width", "height", "unstable"]
    text: str
    segment: SegmentName | None = None
    obstacle: str | None = None
    by: float | None = None
    help: str = ""


class Motion(Protocol):
    """The arms of a bench, as far as a plan needs them. Pure: same question, same answer."""

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        """Return why `robot` can't pick or place `component` at `pose`, lift included, or None where it can.

        `grasp_yaw` [deg] is the direction in which the jaws close, in the component's frame.
        """
        ...

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
        """Return the path that takes `component` from `start` to `goal`, from `joints` (parked where None) to above
        the goal, clear of everything in `standing` (which may hold the component itself at its start) and of the
        `others` among the arms, which stand at these joints, or are parked where they are not named."""
        ...

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
        """Return the path that takes `component`, which `robot` holds at `held` (seen from above) with its arm at
        `joints`, to `goal`, and the hand up from there; `others` as for `move`."""
        ...

    def park(
        self,
        robot: str,
        joints: Joints,
        standing: Mapping[str, StandingObject],
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """Return the path from `joints` to the robot's park pose; `others` as for `move`."""
        ...

    def take(
        self, robot: str, component: str, start: Pose, grasp_yaw: float, standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """Return the path that grips `component` where it stands and lifts it by a hair, to be steered by a person."""
        ...

    def shift(
        self, robot: str, component: str, held: Pose, goal: Pose, standing: Mapping[str, StandingObject],
        joints: Joints, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """Return one small step of `component`, which `robot` holds at `held` with its arm at `joints`, to `goal` at
        the same height; blocked where it would come too near to anything, and where it is no small step."""
        ...

    def let_go(
        self, robot: str, component: str, held: Pose, standing: Mapping[str, StandingObject], joints: Joints,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """Return the path that sets `component`, which `robot` holds at `held`, down where it is, and the hand up."""
        ...

    def use(
        self, robot: str, tool: str, start: Pose, points: Sequence[Waypoint], standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> tuple[MovePath, ...] | Blocked:  # fmt: skip
        """Return the paths that take the part `tool` where it stands at `start`, use it at `points` and put it back;
        each begins where the one before it ends. The rest as for `move`."""
        ...

    def travel(
        self,
        robot: str,
        start: Pose | Joints | None,
        goal: Pose | None,
        start_yaw: float = 0.0,
        goal_yaw: float = 0.0,
    ) -> float:
        """Return how long the empty hand takes from above `start` to above `goal` at transit height [s].

        A place is where a component stands and, with it, the grasp yaw [deg]; None is the park pose; a start may be the
        arm's joints. What `move` takes before it goes down where nothing is in the way; infinite out of reach.
        """
        ...

    def carry(self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float) -> float:
        """Return how long `move` takes from above `start` until it is empty above `goal`, down and up included, where
        nothing is in the way [s]; infinite where it can't."""
        ...
