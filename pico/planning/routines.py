"""What an arm does with a tool for a primitive of a plug-in: the routine that it asks for, and the ways of the arm.

A plug-in brings a routine by the entry point `pico.routines`, under the name of its primitive, whose `by` is `arm`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import cache

from pico.diagnostics import PicoError, error
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json, record
from pico.model.setup import Setup
from pico.motion.types import Blocked, Motion, MovePath, StandingObject, Waypoint
from pico.plug_ins.calling import Interface, Loading, function, instance

GROUP = "pico.routines"


@record
class Routine:
    """What an arm does: it takes the part `tool` where that stands, brings it to the `points` one after the other, and
    puts it back. `commands`: the tunables of the component that are then as they were asked for, which nobody reads."""

    tool: str
    points: tuple[Waypoint, ...]
    commands: Mapping[str, Value] = field(default_factory=dict)


Asked = Callable[[Setup, Observation, Operation], Routine]
"""Returns what an operation asks an arm to do on the bench as it is seen; raises PicoError where that can't be."""


INTERFACE = Interface(GROUP, {"": function}, {"": instance(Routine)})


@cache
def plugged_in() -> Mapping[str, Asked]:
    """Return the routines that plug-ins bring, by the name of their primitive, each loaded when it is asked for."""
    return Loading(INTERFACE)


def routine_of(setup: Setup, seen: Observation, operation: Operation) -> Routine | None:
    """Return what an operation asks an arm to do; None where its primitive is none that an arm does with a tool.

    Raises PicoError for what its plug-in finds wrong, and for a tool or a tunable that there is not, or is not seen.
    """
    asked = plugged_in().get(operation.primitive)
    if asked is None or operation.kind.by != "arm":
        return None
    found, name = asked(setup, seen, operation), operation.component
    if found.tool not in setup.lab.inventory:
        raise _wrong(operation, f"there is no part `{found.tool}`, which it wants as its tool")
    tool = seen.components.get(found.tool)
    if tool is None or tool.presence != "seen" or tool.pose is None:
        raise _wrong(operation, f"its tool {found.tool} is {tool.presence if tool else 'missing'}")
    if unknown := sorted(found.commands.keys() - setup.type_of(name).tunables.keys()):
        raise _wrong(operation, f"{name} has no tunable {', '.join(unknown)}")
    return found


def ways_of(
    setup: Setup, motion: Motion, seen: Observation, robot: str, routine: Routine,
    standing: Mapping[str, StandingObject],
) -> tuple[MovePath, ...] | Blocked:  # fmt: skip
    """Return the ways of an arm for a routine, from where it is."""
    start = seen.components[routine.tool].pose
    assert start is not None  # `routine_of` looked
    others = {name: other.joints for name, other in seen.robots.items() if name != robot}
    return motion.use(robot, routine.tool, start, routine.points, standing, seen.robots[robot].joints, others)


def with_arm(setup: Setup, motion: Motion, seen: Observation, operation: Operation) -> Operation:
    """Return the operation of a routine with the arm that can do it, and how long that takes; raises PicoError where
    none can."""
    routine = routine_of(setup, seen, operation)
    if routine is None:
        return operation
    standing = {
        name: StandingObject(part.pose, setup.type_of(name).geometry)
        for name, part in seen.components.items() if part.pose is not None and part.presence == "seen"
    }  # fmt: skip
    why = "the bench has no arm"
    for robot in sorted(seen.robots):
        ways = ways_of(setup, motion, seen, robot, routine, standing)
        if not isinstance(ways, Blocked):
            return replace(
                operation, robot=robot, resources=(robot, operation.component, routine.tool),
                seconds=sum(way.seconds for way in ways),
            )  # fmt: skip
        why = ways.text
    raise _wrong(operation, why)


def carried(operation: Operation, tool: str, start: Pose) -> Operation:
    """Return the operation as what is done with its tool: that is taken at a place, and put back there."""
    there = {"pose": as_json(start)}
    return replace(operation, component=tool, arguments={**operation.arguments, "from": there, "to": there})


def _wrong(operation: Operation, why: str) -> PicoError:
    text = f"{operation.primitive} of {operation.component} can't be done: {why}"
    return PicoError(error("routine", text, address=operation.component))
