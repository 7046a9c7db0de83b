"""The branches of one laser: the crossings of its light as a tree, and how a finding speaks of one."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from pico.model.arming import LaserClass, within
from pico.model.pose import short
from pico.model.setup import Setup
from pico.optics.audit.findings import ORDINARY, Finding, Kind, Spans
from pico.optics.following import Crossing
from pico.optics.light import Light
from pico.optics.part import Part


@dataclass(frozen=True, eq=False)
class Branches:
    """The light of one laser of a class; `limit` of class 1 at its wavelength [mW], None where none is known; `spans`:
    between which values its mirrors may be driven."""

    setup: Setup
    light: Light
    laser: str
    laser_class: LaserClass
    limit: float | None
    spans: Spans = field(default_factory=dict)

    @property
    def ordinary(self) -> bool:
        """Whether the laser is of class 3R or lower."""
        return within(self.laser_class, ORDINARY)

    @property
    def harmless(self) -> float:
        """The power [mW] up to which a branch harms nobody."""
        return 0.0 if self.limit is None else self.limit

    def of(self, light: Light) -> Branches:
        """Return the same of other light of the same laser."""
        return replace(self, light=light)

    def part(self, crossing: Crossing) -> Part | None:
        """Return the part that a beam comes to, None where it leaves the table."""
        return self.light.parts.get(crossing.component)

    def finding(self, kind: Kind, number: int, where: str, power: float, **more: Any) -> Finding:
        """Return the finding about the beam that comes to a crossing, by its number; `more` of its fields."""
        way = self.light.way(number)
        points = [self.light.parts[self.laser].origin, *(c.beam.at for c in way)]
        x, y, z = (round(float(v), 3) for v in way[-1].beam.at)
        return Finding(
            kind=kind, source=self.laser, laser_class=self.laser_class,
            way=tuple(c.component for c in way[:-1]), where=where, power=power, at=(x, y, z),
            component=way[-1].component,
            path=tuple((round(float(p[0]), 2), round(float(p[1]), 2)) for p in points),
            **{"limit": self.limit, **more},
        )  # fmt: skip


def spot(crossing: Crossing) -> str:
    """Return `(1200, 420)`: where on the table a beam comes to."""
    x, y, _ = crossing.beam.at.tolist()
    return f"({short(x)}, {short(y)})"
