"""Where the components of the simulated table are in space: standing, in a gripper, or fallen over."""

from __future__ import annotations

from pico.backends.sim.world import World
from pico.model.setup import Setup
from pico.motion.kinematics import tool_pose
from pico.twin.placement import Placement, upright
from pico.twin.snapshot import Snapshot


def body_placement(setup: Setup, world: World, name: str) -> Placement | None:
    """Return where a component is in space, or None where it isn't on the table."""
    body = world.components[name]
    if body.presence == "missing" or body.pose is None or name not in setup.lab.inventory:
        return None
    if body.free is not None:
        x, y, z = (v / 1000 for v in body.free.position)
        return Placement((x, y, z), body.free.quaternion)
    if body.presence == "held":
        return upright(body.pose, _in_hand(setup, world, name))
    return upright(body.pose)


def snapshot(setup: Setup, world: World) -> Snapshot:
    """Return what a picture of the world shows at this moment."""
    places = {name: body_placement(setup, world, name) for name in world.components}
    sources = [n for n in places if n in setup.lab.inventory and setup.type_of(n).optics.element == "source"]
    return Snapshot(
        time=world.clock,
        places={name: place for name, place in places.items() if place is not None},
        joints={name: robot.joints for name, robot in world.robots.items()},
        dark=frozenset(n for n in sources if _dark(world, n)),
    )


def _dark(world: World, source: str) -> bool:
    values = world.components[source].values
    return any(
        name in values and values[name].value == off for name, off in (("emission", False), ("shutter", "closed"))
    )


def _in_hand(setup: Setup, world: World, name: str) -> float:
    """The height of the base [mm] of a component that a kinematic world left in a gripper."""
    grasp = setup.type_of(name).geometry.grasp
    for key, robot in world.robots.items():
        if robot.holding == name and grasp is not None and setup.lab.robots[key].model == "xarm7":
            return tool_pose(setup.lab.robots[key], robot.joints)[2] - grasp.height
    return 0.0
