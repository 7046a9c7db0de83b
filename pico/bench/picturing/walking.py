"""Where arms and parts are while something is done: the ways of the arms found anew, by the kinematic model."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count

from pico.backends import ways
from pico.backends.attempt import Failed
from pico.backends.checks import places as places_of
from pico.backends.routines import asked_of
from pico.bench.picturing.deeds import Deed, led_to
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of, tool_point
from pico.motion.types import Blocked, Joints, Motion, MovePath
from pico.twin.moment import Moment, moment_of
from pico.twin.placement import Placement, upright

ANGLE, LENGTH = 0.002, 1.0
"""How far joints [rad] and the tool [mm] may be from straight between two keys."""


@dataclass(frozen=True, slots=True)
class Key:
    """A moment between which and the next one of the same arm or part these move straight: `robots` and `parts` are
    those that it is about. `phases`: what robots begin to do."""

    time: float
    moment: Moment
    robots: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    phases: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class _Step:
    """An arm at a `time` [s] since its operation began; what its hand then takes hold of, or lets go of."""

    time: float
    joints: Joints
    width: float
    phase: str = ""
    takes: tuple[str, Pose] | None = None
    lets: tuple[str, Pose] | None = None


@dataclass(frozen=True, slots=True)
class _Held:
    part: str
    grip: Pose
    low: float


@dataclass
class Walk:
    """Deeds on a bench that was `seen` before them. `told`: what could not be found out."""

    setup: Setup
    motion: Motion
    seen: Observation
    told: list[Diagnostic] = field(default_factory=list)

    def __post_init__(self) -> None:
        first = moment_of(self.seen)
        self._places, self._widths = dict(first.places), dict(first.openings)
        self._held: dict[str, _Held] = {}
        self._number, self._due = count(), list[tuple[float, int, Callable[[float], Key | None]]]()

    def keys(self, deeds: Sequence[Deed]) -> Iterator[Key]:
        """Yield the keys in the order of time."""
        for deed in deeds:
            self._later(deed.start, partial(self._begin, deed))
        while self._due:
            time, _, does = heapq.heappop(self._due)
            if (key := does(time)) is not None:
                yield key

    def _later(self, time: float, does: Callable[[float], Key | None]) -> None:
        heapq.heappush(self._due, (time, next(self._number), does))

    def _begin(self, deed: Deed, time: float) -> None:
        steps, name = self._steps(deed), deed.operation.component
        robot = deed.operation.robot or name
        for step in steps:
            self._later(time + step.time, partial(self._at, robot, step))
        if not steps and name in self._places:  # it stays where it is, and is then elsewhere at once
            self._later(deed.end, partial(self._stays, name))
        self._later(deed.end, partial(self._end, deed))

    def _stays(self, name: str, time: float) -> Key:
        return self._key(time, (), (name,))

    def _at(self, robot: str, step: _Step, time: float) -> Key:
        own = replace(self.seen.robots[robot], joints=step.joints)
        self._widths[robot] = step.width
        if step.takes:
            name, stands = step.takes
            tool = tool_of(self.setup.lab.robots[robot], step.joints)
            low = tool_point(self.setup.lab.robots[robot], step.joints)[2]
            self._held[robot] = _Held(name, tool.inverse().compose(stands), low)
            own = replace(own, holding=name)
            self._presence(name, "held", stands)
        self.seen = replace(self.seen, robots={**self.seen.robots, robot: own}, time=time)
        parts: tuple[str, ...] = ()
        if (held := self._held.get(robot)) is not None:
            self._places[held.part] = self._carried(robot, held)
            parts = (held.part,)
        if step.lets and held is not None:
            del self._held[robot]
            self.seen = replace(self.seen, robots={**self.seen.robots, robot: replace(own, holding=None)})
            self._presence(held.part, "seen", step.lets[1])
            self._places[held.part] = upright(step.lets[1])
        return self._key(time, (robot,), parts, ((robot, step.phase),) if step.phase else ())

    def _end(self, deed: Deed, time: float) -> Key:
        name = deed.operation.component
        after = led_to(deed, self.seen)
        self.seen = replace(self.seen, time=time)
        if after is None or name not in self.seen.components:
            return self._key(time, (), ())
        held = any(one.part == name for one in self._held.values())
        if held and after.presence != "held":
            self._held = {robot: one for robot, one in self._held.items() if one.part != name}
            robots = {
                r: replace(o, holding=None if o.holding == name else o.holding) for r, o in self.seen.robots.items()
            }
            self.seen = replace(self.seen, robots=robots)
        self.seen = replace(self.seen, components={**self.seen.components, name: after})
        if after.pose is not None and after.presence != "held":
            self._places[name] = upright(after.pose)
        elif after.pose is None:
            self._places.pop(name, None)
        return self._key(time, (), (name,) if name in self._places else ())

    def _key(
        self, time: float, robots: tuple[str, ...], parts: tuple[str, ...], phases: tuple[tuple[str, str], ...] = ()
    ) -> Key:
        return Key(time, Moment(self.seen, dict(self._places), dict(self._widths)), robots, parts, phases)

    def _presence(self, name: str, presence: str, pose: Pose) -> None:
        part = replace(self.seen.components[name], presence=presence, pose=pose, how="")  # type: ignore[arg-type]
        self.seen = replace(self.seen, components={**self.seen.components, name: part})

    def _carried(self, robot: str, held: _Held) -> Placement:
        arm, joints = self.setup.lab.robots[robot], self.seen.robots[robot].joints
        return upright(tool_of(arm, joints).compose(held.grip), tool_point(arm, joints)[2] - held.low)

    def _steps(self, deed: Deed) -> list[_Step]:
        """Return how an arm goes through a deed, none where it has no part in it, or nobody knows its way."""
        op = deed.operation
        robot = op.robot or (op.component if op.kind.parks else "")
        if robot not in self.setup.lab.robots or not (op.kind.parks or op.kind.by == "arm"):
            return []
        try:
            found = self._paths(op)
        except (Failed, PicoError):
            found = None
        if found is None:
            text = f"nobody knows which way {robot} went for {op.id} ({op.address}): that is shown where it ended"
            self.told.append(warning("way", text, address=op.component))
            return []
        factor = deed.seconds / found.seconds if deed.outcome == "done" and found.seconds else 1.0
        steps = (replace(step, time=step.time * factor) for step in found.steps(self._width(robot)))
        return [step for step in steps if step.time <= deed.seconds + 1e-6]

    def _width(self, robot: str) -> float:
        return self._widths.get(robot, self.setup.lab.robots[robot].gripper.stroke)

    def _paths(self, op: Operation) -> _Ways | None:
        """Return the ways of an arm for an operation; None where there are none. Raises Failed."""
        arm = self.setup.lab.robots[op.robot or op.component]
        if op.kind.parks:
            path = ways.parking(self.setup, self.motion, self.seen, op.robot or op.component)
            return None if isinstance(path, Blocked) else _Ways(arm, "", None, None, (path,))
        if op.kind.carries:
            start, goal, _ = places_of(op)
            stands, path = ways.carrying(self.setup, self.motion, self.seen, op, start, goal)
            return None if isinstance(path, Blocked) else _Ways(arm, op.component, stands, goal, (path,))
        routine = asked_of(self.setup, self.seen, op)
        if routine is None:
            return None
        start, paths = ways.using(self.setup, self.motion, self.seen, op, routine)
        return _Ways(arm, routine.tool, start, start, paths)


@dataclass(frozen=True, slots=True)
class _Ways:
    """The paths of an arm one after the other, and the part that it takes on them from where to where."""

    arm: Robot
    part: str
    start: Pose | None
    goal: Pose | None
    paths: tuple[MovePath, ...]

    @property
    def seconds(self) -> float:
        return sum(path.seconds for path in self.paths)

    def _spread(self, joints: Joints) -> tuple[float, ...]:
        """Joints, and where the tool is by them, so that LENGTH of that weighs as much as ANGLE of these."""
        tool = tool_of(self.arm, joints)
        return *joints, *(v * ANGLE / LENGTH for v in (tool.x, tool.y, tool_point(self.arm, joints)[2]))

    def steps(self, width: float) -> Iterator[_Step]:
        """Yield the arm, whose pads are `width` [mm] apart at first, from waypoint to waypoint."""
        began = 0.0
        for segment in (segment for path in self.paths for segment in path.segments):
            yield _Step(began, segment.joints[0], width, phase=segment.name)
            kept = thinned(segment.times, [self._spread(joints) for joints in segment.joints])
            for time, joints in ((segment.times[i], segment.joints[i]) for i in kept):
                share = time / segment.seconds if segment.seconds else 1.0
                done = time == segment.times[-1]
                yield _Step(
                    began + time, joints, width + share * (segment.opening - width),
                    takes=(self.part, self.start) if done and segment.name == "grip" and self.start else None,
                    lets=(self.part, self.goal) if done and segment.name == "release" and self.goal else None,
                )  # fmt: skip
            began, width = began + segment.seconds, segment.opening


def thinned(times: Sequence[float], points: Sequence[Sequence[float]]) -> list[int]:
    """Return those of timed points after the first between which all go straight in time, within ANGLE; the last one
    always."""
    kept, first = [], 0
    for last in range(2, len(times)):
        if not _straight(times[first : last + 1], points[first : last + 1]):
            kept.append(last - 1)
            first = last - 1
    return [*kept, len(times) - 1]


def _straight(times: Sequence[float], points: Sequence[Sequence[float]]) -> bool:
    span = times[-1] - times[0]
    if span <= 0:
        return False
    for time, found in zip(times[1:-1], points[1:-1], strict=True):
        share = (time - times[0]) / span
        if any(abs(a + share * (b - a) - q) > ANGLE for a, b, q in zip(points[0], points[-1], found, strict=True)):
            return False
    return True
