"""Benches and moves for the tests of the twin."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.backends.checks import standing
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.world import World, new_world
from pico.manifest.load import load_folder
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.types import MovePath

LABS = Path(__file__).resolve().parent.parent / "labs"


def bench(name: str = "shel") -> Setup:
    """Return one of the example benches."""
    return load_folder(LABS / name).require()[0]


def path_to(setup: Setup, world: World, component: str, goal: Pose) -> MovePath:
    """Return the planner's path of `component` to `goal`."""
    start = world.components[component].pose
    assert start is not None
    joints = world.robots["arm1"].joints
    path = ArmMotion(setup).move("arm1", component, start, goal, 0.0, standing(setup, world), joints)
    assert isinstance(path, MovePath), path
    return path


def to(component: str, goal: Pose) -> Operation:
    """Return the operation that moves `component` to `goal`."""
    arguments = {"to": {"pose": as_json(goal)}, "grasp_yaw": 0.0}
    reason = Reason(kind="asked")
    return Operation(id="op1", primitive="move", component=component, robot="arm1", arguments=arguments, reason=reason)


def finish(physics: PhysicsWorld, work: Any, part: str = "", goal: Pose | None = None) -> dict[str, Any]:
    """Let time pass until `work` is done, and return what it returns; with how far off its goal the part really is."""
    try:
        while True:
            physics.advance(next(work))
    except StopIteration as stop:
        data: dict[str, Any] = stop.value
    if goal is not None:
        pose = physics.twin.placement(part).pose
        data |= {"error_mm": pose.distance(goal), "error_deg": abs(angle_between(goal.yaw, pose.yaw))}
    return data


def carry(physics: PhysicsWorld, work: Any, seconds: float) -> None:
    """Let `seconds` of `work` pass."""
    while seconds > 0:
        wait = next(work)
        physics.advance(wait)
        seconds -= wait


def moved_by_hand(world: World, component: str, dx: float) -> World:
    """Return the world with a component shifted behind the planner's back."""
    pose = world.components[component].pose
    assert pose is not None
    return world.with_body(component, pose=replace(pose, x=pose.x + dx))


def fresh(setup: Setup, friction: float | None = None) -> tuple[World, PhysicsWorld]:
    """Return a new world and the twin of it."""
    world = new_world(setup)
    return world, PhysicsWorld(setup, world, friction=friction)
