"""The simulated table as its cameras see it: pictures of the world as it is, read by the code that reads real ones."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from pico.backends.last_seen import LastSeen, recall_hands, repeated
from pico.backends.sight import Look, look, no_cameras
from pico.backends.sim.bodies import body_placement
from pico.backends.sim.cameras import eyes_of
from pico.backends.sim.senses import let_go, sensed
from pico.backends.sim.world import World, observe
from pico.model.catalog import Geometry
from pico.model.setup import Setup
from pico.places.bench import BenchPlace
from pico.twin.arms import arms_of, motors
from pico.twin.learned import read_learned, with_noise
from pico.twin.placement import Placement
from pico.vision.arm import ArmOffsets
from pico.vision.calibration_files import SIMULATED, known_arms, read_calibration
from pico.vision.frame import exposed

if TYPE_CHECKING:
    from pico.cameras.simulated import Eyes
    from pico.vision.frame import Frame


def see(
    setup: Setup, place: BenchPlace, world: World, backend: str, observed_at: str, last: Mapping[str, LastSeen]
) -> Look:  # fmt: skip
    """Return what the cameras see of `world`; raises PicoError where the lab has none over its table.

    `last`: where parts were seen or put down before. The same world gives the same pictures.
    """
    names = [name for name, camera in sorted(setup.lab.cameras.items()) if camera.robot is None]
    if not names:
        raise no_cameras(setup)
    known = known_arms(place.root, place.name)
    eyes = Posed(with_noise(setup, read_learned(place.root)), world, known).eyes(world)
    pictures = [exposed(partial(eyes.frame, name)) for name in names]
    taken = recall_hands(place)
    if setup.lab.sim.observe == "sight":
        told = sensed(setup, world, taken, backend, observed_at)
    else:
        told = observe(world, backend, observed_at)
    placed = {
        name: LastSeen(pose=pose, uncertainty=repeated(setup, name), time=world.clock, placed=True)
        for name, pose in let_go(setup, told, taken).items()
    }
    return look(setup, pictures, read_calibration(place.root, place.name), told, {**last, **placed})


def picture(setup: Setup, root: Path, world: World, name: str) -> Frame:
    """Return what one camera sees of `world`; black where it was asked often enough."""
    eyes = Posed(with_noise(setup, read_learned(root)), world, known_arms(root, SIMULATED), lit=False).eyes(world)
    return exposed(partial(eyes.frame, name))


_GONE = Placement((0.0, 0.0, -10.0), (1.0, 0.0, 0.0, 0.0))
"""Where no camera sees a part that has left the table since."""


class Posed:
    """The scene of a world, strangers included, that is posed as the world goes on; `known`: how arms are off, as
    calibration found it; `lit`: see `eyes_of`."""

    def __init__(
        self, setup: Setup, world: World, known: Mapping[str, ArmOffsets] | None = None, *, lit: bool = True
    ) -> None:
        import mujoco

        from pico.twin.placement import upright
        from pico.twin.scene import SceneBody, build_scene

        self._setup, places = setup, _places(setup, world)
        things = {name: SceneBody(setup.type_of(name).geometry, place) for name, place in places.items()}
        self._parts = tuple(things)
        for name, stranger in world.unknown.items():
            shape = Geometry(footprint=stranger.footprint, height=stranger.height, mass=1.0)
            things[name] = SceneBody(shape, upright(stranger.pose))
        self._arms = arms_of(setup, world.seed, known)
        self._model = build_scene(setup, things, arms=self._arms).compile()
        self._model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        self._eyes = eyes_of(setup, world, self._model, mujoco.MjData(self._model), lit=lit)

    def eyes(self, world: World) -> Eyes:
        """Return the cameras, which look at `world`."""
        from pico.drawing.picture import pose_model

        places = dict.fromkeys(self._parts, _GONE) | {
            name: place for name, place in _places(self._setup, world).items() if name in self._parts
        }
        joints = {name: robot.joints for name, robot in world.robots.items()}
        pose_model(self._setup, self._model, self._eyes.data, places, motors(self._arms, joints))
        return self._eyes


def _places(setup: Setup, world: World) -> dict[str, Placement]:
    return {name: place for name in world.components if (place := body_placement(setup, world, name))}
