"""What an edge holds a run to where nobody is there, and how it left the bench at its end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from pico.base.state_files import UNATTENDED
from pico.diagnostics import Diagnostic
from pico.model.arming import LaserClass
from pico.model.quantities import Value
from pico.model.record import record

SHUT, PARKED, LAMPS_OFF = "shut", "parked", "lamps off"
ENDS = (SHUT, PARKED, LAMPS_OFF)
"""How a bench may be left: no laser emits; arms are parked; what lights the table is off."""


@record
class Left:
    """How the bench was left: `why` the edge did so by itself (empty: its client asked), the ends that were `reached`,
    what is `wrong`, and what was set for it as it `was` before, by address."""

    why: str = ""
    reached: tuple[str, ...] = ()
    wrong: tuple[Diagnostic, ...] = ()
    was: Mapping[str, Value] = field(default_factory=dict)


@record
class Terms:
    """An unattended run of a `recipe` (`NAME@ID`): the highest class that a laser may emit as, the latest end (`until`,
    ISO 8601, UTC), how often [s] its client says that it goes on, how the bench is left at its `end`; `left` once it
    was."""

    schema: str = UNATTENDED.schema
    recipe: str
    laser_class: LaserClass
    until: str
    every: float
    end: tuple[str, ...] = ENDS
    left: Left | None = None
