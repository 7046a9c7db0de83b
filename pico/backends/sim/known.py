"""What a run knows of the simulated table: all of it exactly, or what a bench with cameras would know and no more."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from pico.backends.sim.world import World, observe
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.motion.types import MovePath

if TYPE_CHECKING:
    pass


class Known(Protocol):
    """What is known of the table while it moves. `corrections`: how often a part is set right that was put down
    wrongly."""

    corrections: int

    def seen(self) -> Observation:
        """Return the table as it is known now; raises Failed where nothing can be seen."""
        ...

    def survey(self, component: str) -> Pose | None:
        """Look at a part before it is picked; return where it was seen, None where it was not."""
        ...

    def takes(self, component: str, path: MovePath) -> None:
        """Be told that a hand goes along `path` to take a part."""
        ...

    def lets_go(self, component: str, path: MovePath, now: float) -> None:
        """Be told that a hand on `path` is about to let go of a part; `now`: on the bench's clock [s]."""
        ...

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Look at a part that was put down near a pose, and return it."""
        ...

    def find(self, component: str) -> ObservedComponent:
        """Look at the whole table for a part that was lost, and return it; `missing` if nothing shows it."""
        ...


class Exactly:
    """The table itself."""

    corrections = 0

    def __init__(self, world: Callable[[], World]) -> None:
        self._world = world

    def seen(self) -> Observation:
        """Return the table as it is."""
        return observe(self._world(), "sim", "")

    def survey(self, component: str) -> Pose | None:
        """See it, always."""
        return self.seen().components[component].pose

    def takes(self, component: str, path: MovePath) -> None:
        """Know it anyway."""

    def lets_go(self, component: str, path: MovePath, now: float) -> None:
        """See where it then stands."""

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Return the part as it is."""
        return self.seen().components[component]

    def find(self, component: str) -> ObservedComponent:
        """Return the part as it is."""
        return self.seen().components[component]
