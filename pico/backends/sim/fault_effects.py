"""What a fault does to the simulated table: to the part in the hand, to what is seen of it, to an axis on its way."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace

from pico.backends import checks
from pico.backends.attempt import Failed
from pico.backends.sim.faults import LOOK, LOOKS, Fault, Faults, beside, room_at
from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.mover import WorldMover
from pico.backends.sim.world import World, observe
from pico.model.catalog import Tunable
from pico.model.observation import ObservedValue, Presence
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.motion.types import Stage

Steps = Generator[float, None, None]
UPRIGHT = 0.7
"""Share of the parts that are dropped and come to stand where there is room."""
REST = 0.3
"""Seconds until an arm that is told to hold is at rest."""
DARK = (1.0, 20.0)
"""For how long a beam is lost, and a detector flooded [s]."""
FLOOD = (30.0, 3000.0)
"""By how much there is too much light then."""


class Mishaps:
    """What goes wrong during one lease. `world` gives the table as it is; `unseen`: what no look showed."""

    def __init__(self, setup: Setup, faults: Faults, token: int, mover: WorldMover, world: Callable[[], World]) -> None:
        self._setup, self._faults, self._token, self._mover, self._world = setup, faults, token, mover, world
        self.unseen: set[str] = set()
        self._odd: tuple[float, float] = (0.0, 1.0)

    def of(self, operation: Operation, key: str) -> Fault | None:
        """Return what goes wrong with an operation, by the lease and by what it is, so that a seed repeats itself."""
        return self._faults.of(operation.primitive, f"{self._token}/{key.partition('/')[2]}")

    def slipped(self, name: str, fault: Fault | None) -> None:
        """Let a part stand where it was put down after it slipped in the hand; in physics friction decides that."""
        if fault is None or fault.kind != "slip" or not isinstance(self._mover, KinematicWorld):
            return
        world = self._world()
        where = beside(checks.standing_pose(observe(world, "sim", ""), name), fault.draw)
        if room_at(self._setup, name, where, _standing(world)):
            self._mover.let_go(name, where, "seen")

    def looked_at(self, name: str, pose: Pose, fault: Fault | None) -> Generator[float, None, Pose]:
        """Return where a part that was put down at `pose` is seen: two looks that agree are believed.

        Raises Failed, outcome unknown, where no look shows it.
        """
        if fault is None or fault.kind not in ("camera", "reading"):
            return pose
        believed: list[Pose] = []
        for reading in _readings(pose, fault):
            if reading is not None and any(reading.distance(other) < 0.5 for other in believed):
                return reading
            believed += [reading] if reading is not None else []
            yield LOOK
        if believed:
            return believed[-1]
        self.unseen.add(name)
        raise Failed(checks.unseen(name), "unknown")

    def strike(self, fault: Fault, robot: str, name: str, let_rest: Callable[[], None]) -> Steps:
        """Let a part drop out of the hand on its way, or the arm stop with it; raises Failed.

        `let_rest` ends what the arm does, so that it holds where it is.
        """
        if self._mover.carried(robot) is None:
            return
        twin = getattr(self._mover, "twin", None)
        if fault.kind == "drop" and twin is not None:
            twin.grip(robot, self._setup.lab.robots[robot].gripper.stroke)
            return  # the mover sees that the hand is empty, and says so
        let_rest()
        yield REST
        pose = self._mover.carried(robot)
        if fault.kind == "jam" or pose is None:
            raise Failed(checks.jammed(robot, name))
        presence = self._fallen(name, pose, fault)
        assert isinstance(self._mover, KinematicWorld)  # else it has a twin
        self._mover.let_go(name, pose, presence)
        raise Failed(checks.dropped(robot, name))

    def shone(self, world: World, fault: Fault | None) -> World:
        """Return a table as its light is now: without any, or with too much of it, for a while; raises Failed where
        what is measured gets lost."""
        if fault is not None and fault.kind == "frame":
            raise Failed(checks.frame_lost())
        if fault is not None and fault.kind in ("beam", "flood"):
            share = 0.0 if fault.kind == "beam" else fault.draw.uniform(*FLOOD)
            self._odd = world.clock + fault.draw.uniform(*DARK), share
        until, share = self._odd
        if world.clock > until:
            return world
        for name in world.components:
            if name in self._setup.lab.inventory and self._setup.type_of(name).optics.element == "source":
                world = world.with_value(name, "walk_power", ObservedValue(value=share - 1.0))
        return world

    def _fallen(self, name: str, pose: Pose, fault: Fault) -> Presence:
        room = room_at(self._setup, name, pose, _standing(self._world()))
        if room is None:
            return "missing"
        return "seen" if room and fault.draw.random() < UPRIGHT else "toppled"


def driven_badly(fault: Fault | None, address: str, seconds: float, stuck: bool = False) -> Steps:
    """Let what is wrong with an axis take its time; raises Failed where it does not get there. `stuck`: it has been
    for some time."""
    if stuck:
        yield seconds
        raise Failed(checks.axis_jammed(address))
    if fault is None:
        return
    if fault.kind == "slow":
        yield 3 * seconds
    elif fault.kind == "reading":
        yield LOOK  # the first reading is wrong, so it is read again, and again
    elif fault.kind in ("jam", "stick"):
        yield seconds * fault.at
        raise Failed(checks.axis_jammed(address))
    elif fault.kind == "timeout":
        yield 2 * seconds
        if fault.draw.random() < 0.5:  # it did nothing; else it did, and only its answer was lost
            raise Failed(checks.no_answer(address))


def on_the_way(kind: Tunable, live: ObservedValue, goal: Value, fault: Fault | None) -> ObservedValue:
    """Return where an axis truly is, which nobody reads, that will stop on its way to `goal`; of others the value with
    which they began."""
    unknown = replace(live, status="unknown")
    if fault is None or fault.kind not in ("jam", "stick") or kind.axis is None:
        return unknown
    if not isinstance(live.value, int | float) or not isinstance(goal, int | float):
        return unknown
    way = goal - live.value
    if kind.period:
        way = (way + kind.period / 2) % kind.period - kind.period / 2
    return replace(unknown, value=live.value + way * fault.at)


def _readings(pose: Pose, fault: Fault) -> list[Pose | None]:
    """What the looks at a part show one after the other: nothing, something wrong, or where it is."""
    blind = fault.draw.randint(1, LOOKS + 1) if fault.kind == "camera" else 0
    wrong = Pose(pose.x + fault.draw.uniform(5, 20), pose.y, pose.yaw)
    first = wrong if fault.kind == "reading" else pose
    return [None if n < blind else first if n == 0 else pose for n in range(LOOKS)]


def _standing(world: World) -> dict[str, Pose]:
    return {n: b.pose for n, b in world.components.items() if b.pose and b.presence != "held"}


def strikes(fault: Fault, stage: Stage) -> bool:
    """Return whether what goes wrong on the way of a part does so by now: in the middle of its transit, or right
    after where nobody looked in between."""
    if fault.kind not in ("drop", "jam"):
        return False
    return stage.segment == "lower" or (stage.segment == "transit" and stage.share >= fault.at)
