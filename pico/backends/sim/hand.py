"""What a hand does to the simulated table, for tests of what a drift, a missing part or a stranger leads to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from pico.backends.sim.world import World, WorldBody, footprints, initial_value
from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.geometry.shape import placed, separation
from pico.model.catalog import Tunable
from pico.model.observation import ObservedRobot, ObservedValue
from pico.model.pose import Pose, wrap
from pico.model.setup import Setup
from pico.model.state import home_state, place_of
from pico.optics import upsets
from pico.optics.unseen import SEEN

_TOUCH = 1e-6  # mm: parts may touch


def nudge(setup: Setup, world: World, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> World:
    """Return the world after a hand shifted `name` by (dx, dy) [mm] and turned it by dyaw [deg], upright.

    A missing part is put to its home first; a held one is taken from the gripper. Raises PicoError for a part that
    the world does not have, and where the part would stand in another one or beside the table.
    """
    body = body_of(world, name)
    start = body.pose or place_of(setup, home_state(setup), name)[1]
    goal = Pose(start.x + dx, start.y + dy, wrap(start.yaw + dyaw))
    problems = list(_obstacles(setup, world, name, goal))
    if problems:
        raise PicoError(problems)
    return _released(world, name).with_body(name, presence="seen", pose=goal, free=None)


def remove(setup: Setup, world: World, name: str) -> World:
    """Return the world after a hand took `name` off the table; raises PicoError for a part that is not there."""
    if body_of(world, name).presence == "missing":
        hint = f"`pico sim nudge {name}` puts it back to its home"
        raise PicoError(error("missing", f"{name} is not on the table", hint=hint, address=name))
    return _released(world, name).with_body(name, presence="missing", pose=None, free=None)


def slip(setup: Setup, world: World, name: str, tunable: str, by: float) -> World:
    """Return the world after the mount of a part slipped: from now on the true value of `tunable` is `by` more, in its
    unit, than its axis reads. Homing the axis does not bring it back.

    Raises PicoError for a part or a tunable that there is not, and for one that nothing moves.
    """
    body, kinds = body_of(world, name), setup.type_of(name).tunables
    kind = kinds.get(tunable)
    if kind is None:
        hint = did_you_mean(tunable, kinds) or "it has none"
        raise PicoError(error("unknown-tunable", f"{name} has no tunable `{tunable}`", hint=hint, address=name))
    if kind.datatype != "float" or (kind.axis is None and kind.mover not in ("motor", "person")):
        text, hint = f"{name}.{tunable} is no place of an axis, so it has no zero that could slip", ""
        if axes := [key for key, other in kinds.items() if other.axis is not None]:
            hint = f"{name} has: {', '.join(axes)}"
        raise PicoError(error("no-axis", text, hint=hint, address=name))
    return world.with_body(name, offsets={**body.offsets, tunable: body.offsets.get(tunable, 0.0) + by})


def upset(setup: Setup, world: World, name: str, by: Mapping[str, float | str]) -> World:
    """Return the world after something befell a part that no camera over the bench sees, see `pico.optics.upsets`;
    raises PicoError for a part or a change that does not exist, and for a value that it cannot have."""
    now = upsets.upset(setup, name, body_of(world, name).unseen or SEEN, by)
    return world.with_body(name, unseen=None if now == SEEN else now)


def clear(world: World, name: str | None = None) -> World:
    """Return the world after what is hidden of a part, by `upset` and `slip`, was taken back; of every part if none is
    named. Raises PicoError for a part that the world does not have."""
    for one in [name] if name is not None else [*world.components]:
        if (body := body_of(world, one)).unseen is not None or body.offsets:
            world = world.with_body(one, unseen=None, offsets={})
    return world


def hidden(setup: Setup, world: World) -> dict[str, dict[str, float | str]]:
    """Return what is hidden of each part of which something is, by the names that `upset` takes; a slipped axis under
    the name of its tunable."""
    found = {
        name: {
            **upsets.said(setup, name, body.unseen or SEEN),
            **{tunable: by for tunable, by in body.offsets.items() if by},
        }
        for name, body in sorted(world.components.items())
        if name in setup.lab.inventory
    }
    return {name: by for name, by in found.items() if by}


def power_cycle(setup: Setup, world: World) -> World:
    """Return the world after its power was off: arms and absolute axes know where they are, axes that must be homed
    don't, open-loop ones are where they were last sent as far as anybody knows; electronics start dark and closed."""
    for name, body in world.components.items():
        tunables = setup.type_of(name).tunables if name in setup.lab.inventory else {}
        values = {key: _powered_up(tunables[key], v) if key in tunables else v for key, v in body.values.items()}
        world = world.with_body(name, values=values)
    return world


def _powered_up(kind: Tunable, live: ObservedValue) -> ObservedValue:
    if kind.axis is not None:
        if kind.axis.kind == "homed":
            return replace(live, status="unknown")
        return live if kind.axis.kind == "absolute" or live.value is None else replace(live, status="commanded")
    if kind.mover != "electronics":
        return live
    return ObservedValue(value=initial_value(kind))


def body_of(world: World, name: str) -> WorldBody:
    """Return a component of the world; raises PicoError for one that it does not have."""
    try:
        return world.components[name]
    except KeyError:
        hint = did_you_mean(name, world.components)
        raise PicoError(error("unknown-component", f"the lab has no part `{name}`", hint=hint)) from None


def _released(world: World, name: str) -> World:
    """Return the world with no robot holding `name`: the hand that held it is opened wide, else its pads, as far apart
    as the part is wide, would still tell of it."""
    hands = set(holders(world, name))
    robots = {k: ObservedRobot(joints=robot.joints) if k in hands else robot for k, robot in world.robots.items()}
    openings = {k: opening for k, opening in world.openings.items() if k not in hands}
    return replace(world, robots=robots, openings=openings)


def holders(world: World, name: str) -> list[str]:
    """Return the robots whose gripper holds `name`."""
    return [key for key, robot in sorted(world.robots.items()) if robot.holding == name]


def _obstacles(setup: Setup, world: World, name: str, goal: Pose) -> Iterator[Diagnostic]:
    width, depth = setup.lab.table.size
    if not (0 <= goal.x <= width and 0 <= goal.y <= depth):
        yield error("off-table", f"{name} would fall off the table at {goal}", address=name)
    shape = placed(world.shapes[world.components[name].type].footprint, goal)
    for other, footprint, pose in footprints(world):
        overlap = -separation(shape, placed(footprint, pose))
        if other != name and overlap > _TOUCH:
            text = f"{name} cannot stand at {goal}: it would overlap {other} by {overlap:.3g} mm"
            yield error("overlap", text, hint=f"{other} stands at {pose}; nudge less, or {other} first", address=name)
