"""What an arm or the part in its hand runs into, looked at in every step of the simulation.

Allowed are the fingers on a part that they grip, and that part on the table where it is picked and placed. All else is
a collision from the first touch, however shallow: contacts push back, so that even a violent one sinks in little.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pico.twin.physics import Twin

TOUCH = 0.01
"""Overlaps below this are rounding [mm]."""


@dataclass(frozen=True, slots=True)
class Touch:
    """A collision: the two geoms, the greatest overlap [mm], and when it was [s]."""

    first: str
    second: str
    depth: float
    time: float


@dataclass(eq=False)
class Watch:
    """Looks at a twin after each of its steps, from now on. `touches` by the names of the two geoms."""

    twin: Twin
    touches: dict[tuple[str, str], Touch] = field(default_factory=dict)
    steps: int = 0

    def __post_init__(self) -> None:
        import numpy as np

        model = self.twin.model
        names = [model.geom(g).name for g in range(model.ngeom)]
        arms = {model.body(f"{arm}/base").rootid[0]: arm for arm in self.twin.arms}
        self._names = names
        self._owner = [arms.get(model.body_rootid[body]) for body in model.geom_bodyid]
        self._arm = np.array([owner is not None for owner in self._owner])
        self._pad = [
            owner is not None and name.endswith("_pad") for owner, name in zip(self._owner, names, strict=True)
        ]
        self._part = [model.body(body).name for body in model.geom_bodyid]
        self.twin.after_step = self.look

    @property
    def deepest(self) -> float:
        """The greatest overlap of anything with an arm or what it carries [mm]; 0 where nothing was touched."""
        return max((touch.depth for touch in self.touches.values()), default=0.0)

    def look(self) -> None:
        """Look at the contacts of the step that was just made."""
        self.steps += 1
        contact = self.twin.data.contact
        overlap = contact.dist
        if not len(overlap) or overlap.min() > -TOUCH / 1000:
            return
        for (a, b), distance in zip(contact.geom.tolist(), overlap.tolist(), strict=True):
            if distance < -TOUCH / 1000 and (self._collides(a, b) or self._collides(b, a)):
                self._note(a, b, -1000 * distance)

    def _collides(self, a: int, b: int) -> bool:
        """Whether `a`, of an arm or of the part in its hand, should not touch `b`."""
        owner = self._owner[a]
        if owner is not None:
            return self._owner[b] is not None or not (self._pad[a] and self._part[b] == self.twin.handles.get(owner))
        if self._owner[b] is not None or self._names[b] == "table":
            return False  # the arm's contacts are looked at from its side
        robot = next((r for r, part in self.twin.handles.items() if part == self._part[a]), None)
        return robot is not None and self.twin.gripped(robot) == self._part[a]

    def _note(self, a: int, b: int, depth: float) -> None:
        pair = (self._names[a], self._names[b])
        if pair not in self.touches or self.touches[pair].depth < depth:
            self.touches[pair] = Touch(*pair, depth, float(self.twin.data.time))
