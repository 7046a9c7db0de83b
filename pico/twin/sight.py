"""Seeing a part in the hand: what a placement is corrected by. Millimetres and degrees, table frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from pico.model.observation import Uncertainty
from pico.model.pose import Pose

if TYPE_CHECKING:
    from pico.twin.physics import Twin


@dataclass(frozen=True, slots=True)
class InHand:
    """A part between the fingers: where its base is seen from above, how high the base is [mm], and how well that is
    known."""

    pose: Pose
    height: float
    uncertainty: Uncertainty


class HandSight(Protocol):
    """Sees parts in hands. An arm is at rest when it is asked."""

    def refer(self, robot: str, component: str, stands: Pose | None) -> bool:
        """Look at a part that still stands, the open hand around it; return whether it is seen.

        What is seen in the hand later can be compared with this: errors that are the same in both pictures cancel.
        `stands`: where others saw it just now, if they did.
        """
        ...

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        """Return where a held part is, or None where no camera sees it."""
        ...


class Exact:
    """A sight without error: the simulated truth. For tests and for the errors of the mechanics alone."""

    def __init__(self, twin: Twin) -> None:
        self._twin = twin

    def refer(self, robot: str, component: str, stands: Pose | None) -> bool:
        """See it, always."""
        return True

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        """Return where the part is."""
        placement = self._twin.placement(component)
        return InHand(placement.pose, placement.position[2] * 1000, Uncertainty())
