"""What somebody in the simulated laboratory can do to its table."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.backends.sim.bodies import body_placement
from pico.backends.sim.cameras import bump
from pico.backends.sim.faults import faults_of, parse, save_faults
from pico.backends.sim.hand import clear, hidden, nudge, power_cycle, remove, slip, upset
from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import World, new_world
from pico.backends.world import Held
from pico.base import clock
from pico.cameras.errors import CameraShift, true_cameras
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.request import require_component
from pico.model.setup import Setup
from pico.places.bench import BenchPlace
from pico.twin.arms import arms_of
from pico.twin.placement import Placement
from pico.vision.arm import ArmOffsets
from pico.vision.camera import CameraModel


class SimulatedTable:
    """The simulated table of the bench at `place`, see `pico.backends.world.World`. `held`, `require_kept`: see
    `pico.backends.device.Device.world`."""

    def __init__(self, setup: Setup, place: BenchPlace, held: Held, require_kept: Callable[[], None]) -> None:
        self._setup, self._place, self._held, self._require_kept = setup, place, held, require_kept

    def placements(self) -> dict[str, Placement]:
        """Return where the components are in space, also those in a gripper or on their side; missing ones are left
        out."""
        world = self._world()
        found = {name: body_placement(self._setup, world, name) for name in world.components}
        return {name: place for name, place in found.items() if place is not None}

    def reset(self, seed: int | None = None) -> None:
        """Put every part home, as in a new world, whatever the world's file holds; `seed`: instead of the Lab's."""
        with self._held("sim reset"):
            world = new_world(self._setup)
            save_world(self._place, world if seed is None else replace(world, seed=seed))

    def put(self, seen: Observation) -> None:
        """Let every part stand and read as in `seen`, in a new world."""
        world = new_world(self._setup)
        for name, part in seen.components.items():
            world = world.with_body(name, pose=part.pose, values=part.values)
        with self._held("sim put"):
            save_world(self._place, world)

    def nudge(self, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> Pose:
        """Push a component by (dx, dy) [mm], turn it by dyaw [deg], and return where it then stands."""
        require_component(self._setup, name)
        self._change(f"sim nudge {name}", lambda world: nudge(self._setup, world, name, dx=dx, dy=dy, dyaw=dyaw))
        pose = self._world().components[name].pose
        assert pose is not None  # it was just put there
        return pose

    def bump(
        self, camera: str | None = None, *, shift: tuple[float, float, float], turn: tuple[float, float, float]
    ) -> None:
        """Bump a camera, so that it looks from elsewhere from now on; all at the table, as one, where none is named.

        `shift` [mm] and the rotation vector `turn` [deg] are along the axes of the table, or of the tool that the
        camera rides on. Raises PicoError for a camera that the lab does not have.
        """
        by = CameraShift(shift=shift, turn=turn)
        self._change(f"sim bump {camera or 'all cameras'}", lambda world: bump(self._setup, world, camera, by))

    def true_cameras(self) -> dict[str, CameraModel]:
        """Return the cameras as they really are: what pictures are taken with, and what calibration has to find."""
        world = self._world()
        return true_cameras(self._setup, self._setup.lab.sim.errors, world.seed, world.cameras)

    def true_arms(self) -> dict[str, ArmOffsets]:
        """Return how the arms are really built: what calibration has to find."""
        return {name: arm.built for name, arm in arms_of(self._setup, self._world().seed).items()}

    def remove(self, name: str) -> None:
        """Take a component off the table: it is then missing."""
        require_component(self._setup, name)
        self._change(f"sim remove {name}", lambda world: remove(self._setup, world, name))

    def slip(self, name: str, tunable: str, by: float) -> None:
        """Let the mount of a part slip: the true value of `tunable` is `by` more from now on, in its unit, than its
        axis reads. Light alone finds it, and homing does not bring it back. Raises PicoError where none has a zero."""
        require_component(self._setup, name)
        self._change(f"sim slip {name}.{tunable}", lambda world: slip(self._setup, world, name, tunable, by))

    def upset(self, name: str, **by: float | str) -> None:
        """Let something befall a part that no camera over the bench sees, `up=0.1` or `loss=0.2`: the fields of
        `pico.optics.unseen.Unseen`, or a `focal_length` [mm]. Light alone finds it. Raises PicoError for a part or a
        change that does not exist."""
        require_component(self._setup, name)
        self._change(f"sim upset {name}", lambda world: upset(self._setup, world, name, by))

    def clear(self, name: str | None = None) -> tuple[str, ...]:
        """Take back what is hidden of a part, by `upset` and `slip`, of every part if none is named; return the parts
        that had something."""
        if name is not None:
            require_component(self._setup, name)
        had = tuple(one for one in self.hidden() if name in (None, one))
        self._change("sim upset --clear", lambda world: clear(world, name))
        return had

    def hidden(self) -> Mapping[str, Mapping[str, float | str]]:
        """Return what is hidden of each part of which something is, by the names that `upset` takes; a slipped axis
        under the name of its tunable."""
        return hidden(self._setup, self._world())

    def wait(self, seconds: float) -> None:
        """Let time pass on the bench's clock [s], in which the world does what it does by itself."""
        passed = max(0.0, seconds)

        def later(world: World) -> World:
            return replace(world, clock=world.clock + passed, waits=(*world.waits, (clock.now_ms(), passed)))

        self._change("sim wait", later)

    def power_cycle(self) -> None:
        """Switch the bench off and on: what must be homed is unknown, electronics are dark and closed."""
        self._change("sim power-cycle", lambda world: power_cycle(self._setup, world))

    def person(self, present: bool) -> None:
        """Let somebody step up to the table, or go away: rules of a policy may ask about it."""
        self._change(f"sim person {'here' if present else 'away'}", lambda world: replace(world, person=present))

    def faults(self, words: Sequence[str] = ()) -> Mapping[str, Any]:
        """Let faults happen from now on, as `drop=0.05 seed=3` says them, or none for `off`; return `rates` and
        `seed` in force.

        Raises PicoError for a fault that there is not.
        """
        if words:
            wanted = parse(words, self._setup.lab.sim.seed)
            save_faults(self._place, wanted)
            if not any(wanted.rates.values()) and self._world().stuck:
                self._change("sim faults", lambda world: replace(world, stuck=()))
        found: dict[str, Any] = as_json(faults_of(self._setup, self._place))
        return found

    def _world(self) -> World:
        self._require_kept()
        return load_world(self._setup, self._place)[0]

    def _change(self, who: str, change: Callable[[World], World]) -> None:
        with self._held(who):
            save_world(self._place, change(self._world()))
