"""What the simulated bench tells besides pictures: joints, the distance between the pads, set-points read back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pico.backends.last_seen import Taken
from pico.backends.sim.world import World, read_back
from pico.model.observation import Observation, ObservedComponent, ObservedRobot
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of, tool_pose
from pico.motion.reach import grasp_height

_LOW = 30.0
"""A hand so near to the height of its grasp goes straight up or down [mm]."""


def sensed(setup: Setup, world: World, taken: Mapping[str, Taken], backend: str, observed_at: str) -> Observation:
    """Return what is known of the bench without looking: no part has a pose but one in a hand.

    `taken`: what each hand took last. Whether it still holds it, the distance between its pads says.
    """
    robots = {name: _felt(setup, world, name, taken.get(name)) for name in world.robots}
    components = {
        n: ObservedComponent(presence="missing", values=read_back(body)) for n, body in world.components.items()
    }
    for name, robot in robots.items():
        if robot.holding:
            pose = tool_of(setup.lab.robots[name], robot.joints).compose(taken[name].pose)
            part = components[robot.holding]
            components[robot.holding] = replace(part, presence="held", pose=pose, how="gripper")
    return Observation(
        backend=backend,
        time=world.clock,
        observed_at=observed_at,
        components=components,
        robots=robots,
        person=world.person,
        waits=world.waits or None,
    )


def let_go(setup: Setup, seen: Observation, taken: Mapping[str, Taken]) -> dict[str, Pose]:
    """Return where hands that are open and low have what they took last: between their fingers, where they let go of
    it, or had not closed on it yet."""
    found = {}
    for name, robot in seen.robots.items():
        arm, took = setup.lab.robots[name], taken.get(name)
        if took is None or robot.holding or not robot.joints or arm.model != "xarm7":
            continue
        geometry = setup.type_of(took.component).geometry if took.component in setup.lab.inventory else None
        if geometry and geometry.grasp and tool_pose(arm, robot.joints)[2] < grasp_height(arm, geometry) + _LOW:
            found[took.component] = tool_of(arm, robot.joints).compose(took.pose)
    return found


def _felt(setup: Setup, world: World, name: str, taken: Taken | None) -> ObservedRobot:
    opening = _opening(setup, world, name)
    grasp = setup.type_of(taken.component).geometry.grasp if taken and taken.component in world.components else None
    holds = taken is not None and grasp is not None and grasp.fits(opening)
    joints = world.robots[name].joints
    return ObservedRobot(joints=joints, holding=taken.component if holds and taken else None, opening=opening)


def _opening(setup: Setup, world: World, name: str) -> float:
    """The distance between the pads of a robot [mm]. A kinematic world has no fingers: its hand is closed on what it
    holds, else open."""
    stroke = setup.lab.robots[name].gripper.stroke
    holding = world.robots[name].holding
    grasp = setup.type_of(holding).geometry.grasp if holding and holding in setup.lab.inventory else None
    return world.openings.get(name, grasp.width if grasp else stroke)
