"""The light of a goal: through which parts it comes to where the goal is measured, by the nominal way of the beams."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pico.model.lab import Goal, Setup
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.vocabulary import measured_in
from pico.optics.axis import beams


@dataclass(frozen=True)
class GoalLight:
    """The `parts` in the beams that reach where a goal is measured, with these and with what is tuned; the `detectors`
    alone; the `sources` of the beams. `order`: how far along its beam the first part that is tuned stands [mm]; None
    where light does not come through all that is tuned to all that is measured: then nothing is to be aligned."""

    parts: frozenset[str]
    detectors: frozenset[str]
    sources: frozenset[str]
    order: float | None


def goal_light(setup: Setup, seen: Observation, goal: Goal) -> GoalLight:
    """Return the light of a goal on the bench as `seen`, whatever is shut."""
    detectors = frozenset(component for component, _ in measured_in(setup, goal.texts))
    tuned = frozenset(address.partition(".")[0] for address in goal.tunables)
    met, sources, reached, lengths = set[str](), set[str](), set[str](), list[float]()
    for axis in beams(setup, standing_poses(seen), seen.known_values):
        for detector in detectors:
            for way in axis.ways(detector):
                met |= {m.component for m in way}
                sources.add(axis.source)
                reached.add(detector)
                lengths += [m.length for m in way if m.component in tuned]
    there = bool(lengths) and reached == detectors and tuned <= met | sources
    return GoalLight(
        frozenset(met | sources | detectors | tuned), detectors, frozenset(sources), min(lengths) if there else None
    )


def standing_poses(seen: Observation) -> Mapping[str, Pose]:
    """Return where what is seen stands, by name."""
    return {n: p.pose for n, p in seen.components.items() if p.presence == "seen" and p.pose is not None}
