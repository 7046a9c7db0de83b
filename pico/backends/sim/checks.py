"""What the simulated bench does not do, and how its interlock shuts lasers."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.checks import has_shutter
from pico.backends.sim.world import World
from pico.diagnostics import Diagnostic, error
from pico.model.observation import ObservedValue
from pico.model.operation import Operation
from pico.model.setup import Setup


def refused(operation: Operation) -> Failed:
    """Return why the simulator does not do a primitive."""
    return Failed(not_simulated(operation.component, operation.primitive))


def not_simulated(component: str, what: str) -> Diagnostic:
    """Return why nothing can be measured."""
    text = f"{what} of {component} is not simulated"
    hint = "poses, set-points, frames of cameras and powers are, and what kernels make of them"
    return error("not-simulated", text, hint=hint, address=component)


def shut(setup: Setup, world: World) -> World:
    """Return the world with the shutter of every laser closed, as the interlock of a bench closes them; the same world
    where they are."""
    for name, body in world.components.items():
        if not has_shutter(setup, name, body.values):
            continue
        if body.values["shutter"].value != "closed":
            world = world.with_value(name, "shutter", ObservedValue(value="closed"))
    return world
