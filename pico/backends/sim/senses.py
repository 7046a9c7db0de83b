"""What the simulated bench tells besides pictures: joints, the distance between the pads, set-points read back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pico.backends.last_seen import Taken
from pico.backends.sim.world import World
from pico.model.lab import Setup
from pico.model.observation import Observation, ObservedComponent, ObservedRobot
from pico.motion.kinematics import tool_of


def sensed(setup: Setup, world: World, taken: Mapping[str, Taken], backend: str, observed_at: str) -> Observation:
    """Return what is known of the bench without looking: no part has a pose but one in a hand.

    `taken`: what each hand took last. Whether it still holds it, the distance between its pads says.
    """
    robots = {name: _felt(setup, world, name, taken.get(name)) for name in world.robots}
    components = {n: ObservedComponent(presence="missing", values=body.values) for n, body in world.components.items()}
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
    )


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
