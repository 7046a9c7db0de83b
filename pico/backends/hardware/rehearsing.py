"""What an arm is to do with a tool, done in the twin first: with the table as it was seen, and friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pico.backends import checks
from pico.backends.attempt import Failed
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.world import World, new_world
from pico.diagnostics import error
from pico.model.observation import Observation, ObservedComponent, ObservedRobot
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.motion.types import MovePath

MOVED = 1.0, 1.0
"""By how much anything but the tool may be moved [mm, deg]."""


def rehearse(setup: Setup, seen: Observation, operation: Operation, tool: str, paths: Sequence[MovePath]) -> None:
    """Go along the paths of an operation in the twin; raises Failed where the tool is not put back, or anything else is
    moved. `operation`: what is done with the tool."""
    world = _world(setup, seen)
    twin = PhysicsWorld(setup, world)
    try:
        for path in paths:
            for seconds in twin.move(operation, path) if path.hands_over else twin.park(path):
                twin.advance(seconds)
    except Failed as exc:
        raise _failed(operation, exc.diagnostic.summary) from exc
    after = twin.world(world)
    now = {n: ObservedComponent(presence=b.presence, pose=b.pose) for n, b in after.components.items()}
    try:
        checks.require_back(setup, tool, now[tool], Pose(**operation.arguments["to"]["pose"]))
    except Failed as exc:
        raise _failed(operation, exc.diagnostic.summary) from exc
    for name, before in world.components.items():
        if name != tool and _moved(before.pose, now[name].pose):
            raise _failed(operation, f"it moves {name}")


def _moved(before: Pose | None, after: Pose | None) -> bool:
    if before is None or after is None:
        return before is not after
    return before.distance(after) > MOVED[0] or abs(angle_between(before.yaw, after.yaw)) > MOVED[1]


def _world(setup: Setup, seen: Observation) -> World:
    """The table as it was seen."""
    new = new_world(setup)
    parts = {
        name: replace(body, presence=part.presence, pose=part.pose)
        for name, body in new.components.items() if (part := seen.components.get(name)) is not None
    }  # fmt: skip
    robots = {name: ObservedRobot(joints=robot.joints) for name, robot in seen.robots.items()}
    return replace(new, components={**new.components, **parts}, robots=robots, unknown=dict(seen.unknown))


def _failed(operation: Operation, why: str) -> Failed:
    text = f"{operation.id}, {operation.primitive} with {operation.component}, fails in the twin: {why}"
    hint = "nothing was moved; give it more room, or another way"
    return Failed(error("rehearsal", text, hint=hint, address=operation.component))
