"""What is to be planned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from pico.model.observation import Observation
from pico.model.operation import Reason
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.motion.types import Motion
from pico.planning.checks.target import Source, no_source
from pico.planning.parts.selection import EVERYTHING, Selection

Preference = Literal["fewest-moves", "shortest-time"]


@dataclass(frozen=True, slots=True)
class Request:
    """What is to be planned. `alone`: one operation was asked for, so nothing else may be moved for it. `prefer`: what
    counts first where an order with more moves takes less time. `only`: the components that are asked for."""

    setup: Setup
    seen: Observation
    wanted: LabState
    motion: Motion | None
    source: Source = no_source
    exact: bool = False
    alone: bool = False
    reason: Reason | None = None
    prefer: Preference = "fewest-moves"
    only: Selection = EVERYTHING
