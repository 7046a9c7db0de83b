"""A bench at one moment as it is shown live: as far as it is known without looking for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from pico.model.observation import Observation
from pico.twin.placement import Placement, upright


@dataclass(frozen=True, slots=True)
class Moment:
    """What is `seen`, its time included; `places`: where components are in space, those missing that are nowhere;
    `openings`: how far the pads of grippers are apart [mm], those missing that do not tell."""

    seen: Observation
    places: Mapping[str, Placement]
    openings: Mapping[str, float] = field(default_factory=dict)


def moment_of(seen: Observation) -> Moment:
    """Return what an observation alone tells: parts stand where they were seen."""
    places = {name: upright(part.pose) for name, part in seen.components.items() if part.pose is not None}
    openings = {name: one.opening for name, one in seen.robots.items() if one.opening is not None}
    return Moment(seen, places, openings)
