"""What the twin of a bench learned from its runs, and injects from then on instead of what was declared.

Nothing that plans or looks reads this: it is how the simulated bench errs, not what anybody knows of the table.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from pico.base.formats import Format
from pico.model.primitive import primitive
from pico.model.record import record
from pico.model.setup import Setup

FORMAT = Format("pico.twin")
WHOLE = ("optimize", "teleoperate", "verify", "survey", "auto_range", "scan")
"""Operations that take as long as what they find asks for."""


@record
class Estimate:
    """A number that runs showed: its `value`, the standard error of that (`sigma`), of how many data (`count`), and
    what the twin had in its place `before`."""

    value: float
    sigma: float
    count: int
    before: float


@record
class Scatter:
    """One standard deviation of a pose: position each way [mm], yaw [deg]; None where there were too few data."""

    position: Estimate | None = None
    yaw: Estimate | None = None


@record
class Learned:
    """What a twin learned, `pico.twin/v1`.

    `runs`: from which, `evidence`: the weakest of theirs. `types`: how parts of a type scatter that are put down;
    `seatings`: the same of all parts with a seating, as multiples of the repeatability of their types, for types of
    which there were too few. `times`: how much longer operations take than the plan reckons, by `work`. `looks`: how
    what is seen of a part at rest scatters from look to look, and `noise` the factor on the noise of the cameras'
    sensors that makes the twin's looks scatter so.
    """

    schema: str = FORMAT.schema
    made_at: str = ""
    evidence: str = ""
    runs: tuple[str, ...] = ()
    types: Mapping[str, Scatter] = field(default_factory=dict)
    seatings: Mapping[str, Scatter] = field(default_factory=dict)
    times: Mapping[str, Estimate] = field(default_factory=dict)
    looks: Scatter | None = None
    noise: float | None = None

    def time(self, work: str | None) -> float:
        """Return how many times longer than planned an operation takes; 1 where nothing was learned of it."""
        found = self.times.get(work) if work else None
        return found.value if found else 1.0


def work(setup: Setup, name: str, component: str, robot: str | None, arguments: Mapping[str, Any]) -> str | None:
    """Return what operations have in common that take longer or shorter alike: `move arm1`, or
    `set linear_polarizer.angle`; None for one that takes as long as it takes."""
    kind = primitive(name)
    if kind.by == "person" or name in WHOLE:
        return None
    if kind.by == "arm":
        return f"{'move' if kind.carries else name} {robot or component}"
    if component not in setup.lab.inventory:
        return None
    of = arguments.get("tunable") or arguments.get("measurable")
    return f"{name} {setup.lab.inventory[component].type}{f'.{of}' if of else ''}"
