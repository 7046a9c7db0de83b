"""What moves the bodies of a simulated world: the same questions to a kinematic and to a physical one."""

from __future__ import annotations

from collections.abc import Generator
from typing import TYPE_CHECKING, Any, Protocol

from pico.backends.sim.world import World
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.motion.types import MovePath, Stage

if TYPE_CHECKING:
    from pico.cameras.simulated import Eyes
    from pico.twin.sight import InHand

InProgress = Generator[float, None, dict[str, Any]]
"""An operation in progress: yields the seconds until it wants to be resumed, returns the data of its result."""


class WorldMover(Protocol):
    """Moves robots and components. The backend alone advances time; generators only say when to resume them."""

    def advance(self, seconds: float) -> None:
        """Let `seconds` pass for all operations in progress."""
        ...

    def move(self, operation: Operation, path: MovePath, stands: Pose | None = None) -> InProgress:
        """Pick and place `operation.component` along `path`; `stands`: where it was seen just now, if it was.

        The generator returns what it corrected, and raises Failed. Closed early, it leaves robot and component as
        they are at that moment.
        """
        ...

    def park(self, path: MovePath) -> InProgress:
        """Bring `path.robot` along `path`, its gripper as it is."""
        ...

    def put(self, component: str, pose: Pose) -> None:
        """Let a person put a component down at a pose on the table."""
        ...

    def stage(self, robot: str) -> Stage:
        """Return how far an arm really is on the path that it executes, or executed last."""
        ...

    def eyes(self, world: World) -> Eyes:
        """Return the cameras, which look at `world` as it is now."""
        ...

    def left(self, component: str) -> InHand | None:
        """Return where the eye in a hand saw a component when the hand let go of it; None where none did."""
        ...

    def carried(self, robot: str) -> Pose | None:
        """Return where the component in the gripper of `robot` is, seen from above, or None where it holds none."""
        ...

    def world(self, world: World) -> World:
        """Return `world` with poses, presence, joints and what is held as they are now. Nothing else changes."""
        ...
