"""The light of a goal: through which parts it comes to where the goal is measured, by the nominal way of the beams."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from pico.model.diff import show_value
from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.vocabulary import measured_in
from pico.optics.axis import Meeting, Values, beams
from pico.optics.ends import SHUTS, closures
from pico.optimize.choosing import CYCLES
from pico.planning.nominal_bench import STEERS, straight


@dataclass(frozen=True)
class GoalLight:
    """The `parts` in the beams that reach where a goal is measured, with these and with what is tuned; the `detectors`
    alone; the `sources` of the beams. `order`: how far along its beam the first part that is tuned stands [mm]; None
    where light does not come through all that is tuned to all that is measured: then nothing is to be aligned.
    `beyond`: parts behind the last polarizer, where the angle of a polarizer or wave plate is sought: how much light
    they let through turns no null. `dark`: what is tuned and no light comes through, and
    detectors that none reaches."""

    parts: frozenset[str]
    detectors: frozenset[str]
    sources: frozenset[str]
    order: float | None
    beyond: frozenset[str] = frozenset()
    dark: frozenset[str] = frozenset()


def goal_light(setup: Setup, seen: Observation, goal: Goal) -> GoalLight:
    """Return the light of a goal on the bench as `seen`, whatever is shut; as its mirrors were meant, where they are
    turned so far that only then it comes there."""
    found = _light(setup, seen, goal, seen.known_values)
    if found.order is not None or not any(address.rpartition(".")[2] in STEERS for address in goal.tunables):
        return found
    meant = _light(setup, seen, goal, straight(seen.known_values))
    return found if meant.order is None else meant


def _light(setup: Setup, seen: Observation, goal: Goal, values: Values) -> GoalLight:
    detectors = frozenset(component for component, _ in measured_in(setup, goal.texts))
    tuned = frozenset(address.partition(".")[0] for address in goal.tunables)
    met, sources, reached, lengths = set[str](), set[str](), set[str](), list[float]()
    counting = set[str]()
    turned = tuned if _turns(setup, goal) else frozenset[str]()
    for axis in beams(setup, standing_poses(seen), values):
        for detector in detectors:
            for way in axis.ways(detector):
                met |= {m.component for m in way}
                counting |= _counting(setup, way, turned)
                sources.add(axis.source)
                reached.add(detector)
                lengths += [m.length for m in way if m.component in tuned]
    there = bool(lengths) and reached == detectors and tuned <= met | sources
    return GoalLight(
        frozenset(met | sources | detectors | tuned), detectors, frozenset(sources), min(lengths) if there else None,
        frozenset(met - counting - detectors), frozenset((tuned - met - sources) | (detectors - reached)),
    )  # fmt: skip


def _turns(setup: Setup, goal: Goal) -> bool:
    """Return whether a goal is one of polarization: as much or as little light as can be, by one angle."""
    kinds = [setup.type_of(address.partition(".")[0]).optics.element for address in goal.tunables]
    return (
        goal.aim != "reach" and len(kinds) == 1 and kinds[0] in CYCLES and next(iter(goal.tunables)).endswith(".angle")
    )


def _counting(setup: Setup, way: Sequence[Meeting], turned: Collection[str]) -> set[str]:
    """Return the parts on a way that count for a goal: all, or those up to the last polarizer behind what is turned."""
    last = [n for n, m in enumerate(way) if setup.lab.inventory.get(m.component) and _polarizes(setup, m.component)]
    within = bool(last) and any(m.component in turned for m in way[: last[-1] + 1])
    return {m.component for m in (way[: last[-1] + 1] if within else way)}


def _polarizes(setup: Setup, name: str) -> bool:
    return setup.type_of(name).optics.element == "polarizer"


def kept_back(setup: Setup, seen: Observation, parts: Collection[str], opened: Mapping[str, Value]) -> str:
    """Return what keeps light back on its way through parts, in words: a source that is off, or a shutter; empty for
    nothing. `opened`: what is set otherwise meanwhile, by address."""
    known = seen.known_values
    for name in sorted(parts):
        own = {t: opened.get(f"{name}.{t}", known.get(name, {}).get(t)) for t in SHUTS}
        for tunable, value in closures(own) if setup.type_of(name).optics.element in ("source", "shutter") else ():
            return f"{name}.{tunable} is {show_value(value)}"
    return ""


def standing_poses(seen: Observation) -> Mapping[str, Pose]:
    """Return where what is seen stands, by name."""
    return {n: p.pose for n, p in seen.components.items() if p.presence == "seen" and p.pose is not None}
