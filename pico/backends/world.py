"""The simulated world behind a device: a capability that hardware lacks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from pico.model.observation import Observation
    from pico.model.pose import Pose
    from pico.twin.placement import Placement
    from pico.vision.arm import ArmOffsets
    from pico.vision.camera import CameraModel

Held = Callable[[str], AbstractContextManager[Any]]
"""Locks the bench for who is named while a change lasts; raises PicoError (code LOCKED) where somebody moves it."""


class World(Protocol):
    """What somebody in the simulated laboratory can do to its table. Changing it while it moves raises PicoError."""

    def placements(self) -> Mapping[str, Placement]:
        """Return where the components are in space, those in a gripper or on their side, too; missing ones are left
        out."""
        ...

    def reset(self, seed: int | None = None) -> None:
        """Put every part home, as in a new world, whatever is stored; `seed`: instead of the Lab's."""
        ...

    def put(self, seen: Observation) -> None:
        """Let every part stand and read as in `seen`, in a new world."""
        ...

    def nudge(self, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> Pose:
        """Push a component by (dx, dy) [mm], turn it by dyaw [deg], and return where it then stands."""
        ...

    def bump(
        self, camera: str | None = None, *, shift: tuple[float, float, float], turn: tuple[float, float, float]
    ) -> None:
        """Bump a camera, all at the table where none is named, by `shift` [mm] and the rotation vector `turn` [deg]."""
        ...

    def true_cameras(self) -> Mapping[str, CameraModel]:
        """Return the cameras as they really are: what pictures are taken with, and what calibration has to find."""
        ...

    def true_arms(self) -> Mapping[str, ArmOffsets]:
        """Return how the arms are really built: what calibration has to find."""
        ...

    def remove(self, name: str) -> None:
        """Take a component off the table: it is then missing."""
        ...

    def slip(self, name: str, tunable: str, by: float) -> None:
        """Let the mount of a part slip: the true value of `tunable` is `by` more from now on, in its unit, than its
        axis reads. Light alone finds it, and homing does not bring it back. Raises PicoError where none has a zero."""
        ...

    def upset(self, name: str, **by: float | str) -> None:
        """Let something befall a part that no camera over the bench sees, `up=0.1` or `loss=0.2`: the fields of
        `pico.optics.unseen.Unseen`, or a `focal_length` [mm]. Light alone finds it. Raises PicoError for a part or a
        change that does not exist."""
        ...

    def clear(self, name: str | None = None) -> tuple[str, ...]:
        """Take back what is hidden of a part, by `upset` and `slip`, of every part if none is named; return the parts
        that had something."""
        ...

    def hidden(self) -> Mapping[str, Mapping[str, float | str]]:
        """Return what is hidden of each part of which something is, by the names that `upset` takes; a slipped axis
        under the name of its tunable."""
        ...

    def wait(self, seconds: float) -> None:
        """Let time pass on the bench's clock [s], in which the world does what it does by itself."""
        ...

    def power_cycle(self) -> None:
        """Switch the bench off and on: what must be homed is unknown, electronics are dark and closed."""
        ...

    def person(self, present: bool) -> None:
        """Let somebody step up to the table, or go away."""
        ...

    def faults(self, words: Sequence[str] = ()) -> Mapping[str, Any]:
        """Let faults happen from now on, none for `off`; return `rates` and `seed` in force. Raises PicoError."""
        ...
