"""The cameras of a simulated world: wrong by the lab's errors, bumped as the world remembers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.sim.world import World
from pico.cameras.errors import CameraShift, common_shifts, true_cameras
from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.setup import Setup
from pico.model.simulated import BadLight
from pico.planning.checks.interlocks import LAMP

if TYPE_CHECKING:
    import mujoco

    from pico.cameras.simulated import Eyes


def eyes_of(
    setup: Setup, world: World, model: mujoco.MjModel, data: mujoco.MjData, *, lit: bool = True
) -> Eyes:  # fmt: skip
    """Return the cameras of `world`, looking at its scene `model`: each part carries the marker that it has there.

    `lit`: as a bench looks, that turns on for it what lights the room; else it is as dark as its lamps leave it.
    """
    from pico.cameras.simulated import Eyes

    cameras = true_cameras(setup, setup.lab.sim.errors, world.seed, world.cameras)
    markers = {name: body.marker for name, body in world.components.items()} | dict(world.stickers)
    errors = setup.lab.sim.errors
    if not lit and lamps(setup, world) and not any(lamps(setup, world).values()):
        errors = replace(errors, light=BadLight(dim=0.0))
    return Eyes(setup, model, data, cameras, errors=errors, seed=world.seed, markers=markers)


def lamps(setup: Setup, world: World) -> dict[str, bool]:
    """Return the lamps of the room, and whether each is on; a room without any is lit."""
    own = {n: b.values[LAMP].value for n, b in world.components.items() if n in setup.lab.inventory if LAMP in b.values}
    return {name: value is True for name, value in own.items()}


def bump(setup: Setup, world: World, name: str | None, by: CameraShift) -> World:
    """Return the world with camera `name` bumped, or with all cameras at the table moved as one where it is None.

    Raises PicoError for a camera that the lab does not have.
    """
    if name is not None and name not in setup.lab.cameras:
        hint = did_you_mean(name[:40], setup.lab.cameras) or "this lab has no cameras"
        raise PicoError(error("unknown-camera", f"no camera `{name[:40]}`", hint=hint))
    if name is not None:
        shifts = {name: by}
    else:
        true = true_cameras(setup, setup.lab.sim.errors, world.seed, world.cameras)
        shifts = common_shifts(true, by)
    moved = {n: world.cameras.get(n, CameraShift()).then(shift) for n, shift in shifts.items()}
    return replace(world, cameras={**world.cameras, **moved})
