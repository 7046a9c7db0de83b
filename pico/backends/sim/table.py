"""What somebody in the simulated laboratory can do to its table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pico.backends.sim.bodies import body_placement
from pico.backends.sim.cameras import bump
from pico.backends.sim.faults import Faults, faults_of, parse, save_faults
from pico.backends.sim.hand import nudge, power_cycle, remove
from pico.backends.sim.store import change_world, load_world, reset_world
from pico.cameras.errors import CameraShift, true_cameras
from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.model.request import require_component
from pico.twin.placement import Placement
from pico.vision.camera import CameraModel


class SimulatedTable:
    """The simulated table of the lab in folder `root`. Changing it while it moves raises PicoError (code LOCKED)."""

    def __init__(self, setup: Setup, root: Path) -> None:
        self._setup, self._root = setup, root

    def placements(self) -> dict[str, Placement]:
        """Return where the components are in space, also those in a gripper or on their side; missing ones are left
        out."""
        world, _ = load_world(self._setup, self._root)
        found = {name: body_placement(self._setup, world, name) for name in world.components}
        return {name: place for name, place in found.items() if place is not None}

    def reset(self) -> None:
        """Put every part home, as in a new world, whatever the world's file holds."""
        reset_world(self._setup, self._root, "sim reset")

    def nudge(self, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> Pose:
        """Push a component by (dx, dy) [mm], turn it by dyaw [deg], and return where it then stands."""
        require_component(self._setup, name)
        change_world(
            self._setup, self._root, f"sim nudge {name}",
            lambda world: nudge(self._setup, world, name, dx=dx, dy=dy, dyaw=dyaw),
        )  # fmt: skip
        pose = load_world(self._setup, self._root)[0].components[name].pose
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
        who = f"sim bump {camera or 'all cameras'}"
        change_world(self._setup, self._root, who, lambda world: bump(self._setup, world, camera, by))

    def true_cameras(self) -> dict[str, CameraModel]:
        """Return the cameras as they really are: what pictures are taken with, and what calibration has to find."""
        world, _ = load_world(self._setup, self._root)
        return true_cameras(self._setup, self._setup.lab.sim.errors, world.seed, world.cameras)

    def remove(self, name: str) -> None:
        """Take a component off the table: it is then missing."""
        require_component(self._setup, name)
        change_world(
            self._setup, self._root, f"sim remove {name}", lambda world: remove(self._setup, world, name)
        )  # fmt: skip

    def power_cycle(self) -> None:
        """Switch the bench off and on: what must be homed is unknown, electronics are dark and closed."""
        change_world(self._setup, self._root, "sim power-cycle", lambda world: power_cycle(self._setup, world))

    def person(self, present: bool) -> None:
        """Let somebody step up to the table, or go away: rules of a policy may ask about it."""
        who = f"sim person {'here' if present else 'away'}"
        change_world(self._setup, self._root, who, lambda world: replace(world, person=present))

    def faults(self, words: Sequence[str] = ()) -> Faults:
        """Let faults happen from now on, as `drop=0.05 seed=3` says them, or none for `off`; return what is in force.

        Raises PicoError for a fault that there is not.
        """
        if words:
            save_faults(self._root, parse(words, self._setup.lab.sim.seed))
        return faults_of(self._setup, self._root)
