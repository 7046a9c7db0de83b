"""Parts that are not where they should be: what is said about them."""

from __future__ import annotations

from pico.diagnostics import Diagnostic
from pico.model.pose import Pose
from pico.twin.placement import Placement

TOPPLED = 5.0
"""A part that leans more than this does not stand [deg]."""
FALLEN = -20.0
"""A part whose base is lower than this has left the table [mm]."""


class Lost(Exception):
    """A part that is not where it should be: missed, dropped, slipped, toppled, unseen. Carries the diagnostic."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.summary)


def whereabouts(component: str, placement: Placement) -> tuple[str, str]:
    """Return where a part is, in words, and what to do about it."""
    by_hand = f"put it upright by hand (`pico sim nudge {component}` in the simulator), then plan again"
    pose = placement.pose
    if placement.position[2] * 1000 < FALLEN:
        return "it fell off the table", by_hand
    if lies(placement):
        return f"it lies on its side at x = {pose.x:.0f}, y = {pose.y:.0f}", by_hand
    tidy = Pose(round(pose.x, 1) + 0.0, round(pose.y, 1) + 0.0, round(pose.yaw, 1) + 0.0)
    return f"it stands at {tidy}", "plan again: it starts from what stands on the table now"


def lies(placement: Placement) -> bool:
    """Return whether a part does not stand upright."""
    return placement.tilt > TOPPLED
