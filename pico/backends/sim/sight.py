"""The simulated table as its cameras see it: pictures of the world as it is, read by the code that reads real ones."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pico.backends.last_seen import LastSeen
from pico.backends.sight import Look, look, no_cameras
from pico.backends.sim.bodies import body_placement
from pico.backends.sim.cameras import eyes_of
from pico.backends.sim.world import World, observe
from pico.model.catalog import Geometry
from pico.model.lab import Setup
from pico.twin.arms import arms_of, motors
from pico.vision.arm import ArmOffsets
from pico.vision.calibration import known_arms, read_calibration

if TYPE_CHECKING:
    import mujoco

    from pico.cameras.simulated import Eyes
    from pico.vision.frame import Frame

TRIES = 3
"""Pictures that are asked of a camera before it counts as lost."""


def see(setup: Setup, root: Path, world: World, backend: str, observed_at: str, last: Mapping[str, LastSeen]) -> Look:
    """Return what the cameras see of `world`; raises PicoError where the lab has none over its table.

    `last`: where parts were seen or put down before. The same world gives the same pictures.
    """
    names = [name for name, camera in sorted(setup.lab.cameras.items()) if camera.robot is None]
    if not names:
        raise no_cameras(setup)
    eyes = eyes_of(setup, world, *scene_of(setup, world, known_arms(root)))
    pictures = [_picture(eyes, name) for name in names]
    return look(setup, pictures, read_calibration(root), observe(world, backend, observed_at), last)


def picture(setup: Setup, root: Path, world: World, name: str) -> Frame:
    """Return what one camera sees of `world`; black where it was asked often enough."""
    return _picture(eyes_of(setup, world, *scene_of(setup, world, known_arms(root))), name)


def _picture(eyes: Eyes, name: str) -> Frame:
    frame = eyes.frame(name)
    for _ in range(TRIES - 1):
        if not frame.black:
            break
        frame = eyes.frame(name)
    return frame


def scene_of(
    setup: Setup, world: World, known: Mapping[str, ArmOffsets] | None = None
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the scene of a world, strangers included, ready to be looked at; `known`: how arms are off, as calibration
    found it."""
    import mujoco

    from pico.drawing.picture import pose_model
    from pico.twin.placement import upright
    from pico.twin.scene import SceneBody, build_scene

    places = {name: place for name in world.components if (place := body_placement(setup, world, name))}
    things = {name: SceneBody(setup.type_of(name).geometry, place) for name, place in places.items()}
    for name, stranger in world.unknown.items():
        shape = Geometry(footprint=stranger.footprint, height=stranger.height, mass=1.0)
        things[name] = SceneBody(shape, upright(stranger.pose))
    arms = arms_of(setup, world.seed, known)
    model = build_scene(setup, things, arms=arms).compile()
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    data = mujoco.MjData(model)
    pose_model(setup, model, data, places, motors(arms, {name: robot.joints for name, robot in world.robots.items()}))
    return model, data
