"""How long the bench needs about from one state to another, without planning it: what the choice of a trial weighs.

The sum over the parts that differ of the arm's own time to carry each (as `pico.motion.travel` has it, with nothing in
the way) and of an empty way in between; motors and set-points beside it. What is put aside on the way is left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from pico.model.diff import diff_observed
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setpoint import set_seconds
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.motion.deferred import DeferredMotion

BY_HAND = 60.0
"""What is reckoned with for something that a person does [s]; as in plans."""
NEARER = 0.9
"""Share of the mean empty way between any two moves that a plan needs in its order: it takes near ones in turn."""

Leaves = tuple[tuple[str, str | None, Pose, tuple[tuple[str, Value], ...]], ...]


def leaves(setup: Setup, state: LabState) -> Leaves:
    """Return where every part of the bench belongs in a state, and its values: equal for states that are one to it."""
    found = []
    for name in sorted(setup.lab.inventory):
        part = state.components.get(name)
        slot, pose = place_of(setup, state, name)
        found.append((name, slot, pose, tuple(sorted(part.values.items())) if part else ()))
    return tuple(found)


@dataclass
class PlanSeconds:
    """The seconds of plans between states of one bench; remembers what it worked out."""

    setup: Setup
    _motion: DeferredMotion = field(init=False)
    _carried: dict[tuple[str, Pose, Pose], tuple[str, float]] = field(default_factory=dict)
    _hops: dict[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._motion = DeferredMotion(self.setup)

    def between(self, a: Leaves, b: Leaves) -> float:
        """Return about how long it takes from a state to another [s]."""
        moves, values = [], []
        for (name, slot_a, pose_a, values_a), (_, slot_b, pose_b, values_b) in zip(a, b, strict=True):
            if (slot_a, pose_a) != (slot_b, pose_b):
                moves.append((name, pose_a, pose_b))
            if values_a != values_b:
                before = dict(values_a)
                values += [(name, k, before.get(k), v) for k, v in values_b if before.get(k) != v]
        return self._total(moves, values)

    def to(self, seen: Observation, goal: LabState) -> float:
        """Return about how long it takes from the bench as it stands to a state [s]."""
        moves, values = [], []
        for change in diff_observed(self.setup, seen, goal):
            part = seen.components[change.component]
            if not change.counts or part.pose is None:
                continue
            if change.tunable == "pose":
                moves.append((change.component, part.pose, place_of(self.setup, goal, change.component)[1]))
            else:
                values.append((change.component, change.tunable, change.before, change.after))
        return self._total(moves, values)

    def _total(
        self, moves: list[tuple[str, Pose, Pose]], values: list[tuple[str, str, Value | None, Value]]
    ) -> float:  # fmt: skip
        """Return the longest of what each arm needs and the values, plus what people do."""
        arms: dict[str, float] = {}
        hands = 0.0
        for name, start, goal in moves:
            robot, seconds = self._carry(name, start, goal)
            if robot:
                arms[robot] = arms.get(robot, self._hop(robot)[0]) + seconds + self._hop(robot)[1]
            else:
                hands += seconds
        motors: dict[str, float] = {}
        for name, tunable, before, after in values:
            kind = self.setup.type_of(name).tunables.get(tunable)
            if kind is None or kind.mover == "none":
                continue
            if kind.mover in ("motor", "electronics"):
                motors[name] = motors.get(name, 0.0) + set_seconds(kind, before, after)
            else:
                hands += BY_HAND
        return max([0.0, *arms.values(), *motors.values()]) + hands

    def _carry(self, name: str, start: Pose, goal: Pose) -> tuple[str, float]:
        """Return the arm that carries a part soonest, and its time; a person where no arm can."""
        key = (name, start, goal)
        if key not in self._carried:
            self._carried[key] = min(self._ways(*key), key=lambda way: way[1], default=("", BY_HAND))
        return self._carried[key]

    def _ways(self, name: str, start: Pose, goal: Pose) -> Iterator[tuple[str, float]]:
        grasp = self.setup.type_of(name).geometry.grasp
        if not self.setup.movable(name) or grasp is None:
            return
        for robot in sorted(self.setup.lab.robots):
            for yaw in grasp.yaws:
                seconds = self._motion.carry(robot, name, start, goal, yaw)
                if math.isfinite(seconds):
                    yield robot, seconds

    def _hop(self, robot: str) -> tuple[float, float]:
        """Return what an arm needs to come and to park less what it saves between moves, and between two moves [s]."""
        if robot not in self._hops:
            places = [slot.pose for _, slot in sorted(self.setup.lab.slots.items())][:12]
            park = [self._motion.travel(robot, None, at) for at in places]
            ways = [self._motion.travel(robot, a, b) for a in places for b in places if a is not b]
            away, hop = (_mean([s for s in some if math.isfinite(s)]) for some in (park, ways))
            self._hops[robot] = 2 * away - NEARER * hop, NEARER * hop
        return self._hops[robot]


def _mean(some: list[float]) -> float:
    return sum(some) / len(some) if some else 0.0
