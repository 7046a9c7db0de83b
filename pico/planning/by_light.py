"""The goals that set-points found by light are: which tunables are searched, what is measured, and where.

`reference_goals` is the one way from references to goals. It is pure: the same references on the same bench as seen
give the same goals, named as `LightReference.goal` says (`p2.angle`, `through iris1 iris2`), so whoever compiles a plan
seeks them like goals of the Lab: `optimizing(setup, seen, turns, motion)`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.diff import deviation
from pico.model.goal import Goal
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import NULL, THROUGH, LabState, LightReference, goals_of, place_of
from pico.model.vocabulary import numbers_of
from pico.optics.axis import Meeting, Values, beams
from pico.planning.asked import LIGHT, Asked, Ready
from pico.planning.nominal import aimed, within_reach
from pico.planning.two_irises import in_order, two_irises

WITHIN = 0.2
"""How well a place is to be known that light finds, as a share of the tolerance of its tunable."""


@dataclass(frozen=True)
class ByLight:
    """The goals of references by name, with what is sought first where it is dark and where the nominal beam is right;
    and of those that can't be sought why not (`wrong`)."""

    ready: Mapping[str, Ready] = field(default_factory=dict)
    wrong: Mapping[str, Diagnostic] = field(default_factory=dict)

    @property
    def goals(self) -> Mapping[str, Goal]:
        """The goals themselves, by name."""
        return {name: one.goal for name, one in self.ready.items()}


def reference_goals(
    setup: Setup,
    wanted: Mapping[str, Mapping[str, LightReference]],
    seen: Observation,
    meant: Observation | None = None,
) -> ByLight:
    """Return the goals that references are, given by the name of their goal and their address, on a bench as seen.
    `meant`: the same with parts that stand well enough exactly where they should: which beam is to go where. Without,
    that is as seen, and mirrors have their whole ranges: what it takes to say how goals stand, not to seek them."""
    if not wanted:
        return ByLight()
    standing = {n: p.pose for n, p in seen.components.items() if p.presence == "seen" and p.pose is not None}
    poses = {name: pose for name, pose in standing.items() if name in setup.lab.inventory}
    nulls = {name for name, found in wanted.items() if next(iter(found.values())).kind == NULL}
    ways = tuple(_ways(setup, poses, seen.known_values)) if nulls else ()
    ready, wrong = dict[str, Ready](), dict[str, Diagnostic]()
    for name, references in wanted.items():
        ((address, one), *_) = references.items()
        try:
            null = name in nulls
            goal = Ready(name, _null(setup, address, one, ways)) if null else _through(setup, seen, meant, references)
            ready[name] = replace(goal, name=name)
        except PicoError as exc:
            wrong[name] = exc.diagnostics[0]
    return ByLight(ready, wrong)


def _ways(setup: Setup, poses: Mapping[str, Pose], values: Values) -> Iterator[tuple[Meeting, ...]]:
    """Yield each way of a beam to a detector that tells how much light comes to it, the detector last."""
    detectors = [name for name in sorted(poses) if _power(setup, name)]
    for axis in beams(setup, poses, values):
        for name in detectors:
            yield from (way for way in axis.ways(name) if way[-1].event == "detected")


def _power(setup: Setup, name: str) -> str:
    """Return the number by which a detector tells how much light comes to it; empty for what is none."""
    if setup.type_of(name).optics.element != "detector":
        return ""
    numbers = numbers_of(setup, name)
    return next((f"{name}.{number}" for number in LIGHT if number in numbers), "")


def _null(
    setup: Setup, address: str, one: LightReference, ways: Sequence[tuple[Meeting, ...]]
) -> Goal:  # fmt: skip
    """Return the goal of a null; raises PicoError where no light comes through its parts."""
    component, _, tunable = address.partition(".")
    wanted = dict.fromkeys((*one.parts, component))
    if why := _astray(address, tuple(wanted), ways):
        raise PicoError(why)
    fit = [way for way in ways if wanted.keys() <= {m.component for m in way}]
    detector = min(fit, key=lambda way: (way[-1].length, way[-1].component))[-1].component
    kind = setup.type_of(component).tunables[tunable]
    half = (kind.period or 180.0) / 2
    return Goal(
        tunables={address: kind.range or (-half, half)}, minimize=_power(setup, detector), offset=one.offset,
        description=one.text, parameters={"within": WITHIN * kind.tolerance} if kind.tolerance > 0 else None,
    )  # fmt: skip


def _astray(address: str, parts: Sequence[str], ways: Sequence[tuple[Meeting, ...]]) -> Diagnostic | None:
    """Return why no light goes through parts to a detector; None where it does."""
    met = [{m.component for m in way} for way in ways]
    if any(set(parts) <= way for way in met):
        return None
    off = [part for part in parts if not any(part in way for way in met)]
    hint = (
        "`pico beam` shows where light goes; a power meter, a photodiode or a camera behind them tells how much passes"
    )
    if off:
        text = f"{address} can't be found by light: no light comes through {' and '.join(off)} to a detector"
    else:
        text = f"{address} can't be found by light: {', '.join(parts)} are not on one way to a detector"
    return error("by-light", text, hint=hint, address=address)


def _through(
    setup: Setup, seen: Observation, meant: Observation | None, references: Mapping[str, LightReference]
) -> Ready:  # fmt: skip
    """Return the goal of mirrors that bring a beam through two irises; raises PicoError where it can't be made."""
    one = next(iter(references.values()))
    asked = Asked(setup, meant or seen, THROUGH, one.parts)
    try:
        near, far = in_order(asked, one.parts)
        way = asked.way(near)[:-1]
        mirrors = {address.partition(".")[0]: None for address in references}
        for mirror in (name for name in mirrors if name not in way):
            raise asked.refused(f"no light comes from {mirror} to {near}", "`pico beam` shows where it goes")
        own = sorted(references, key=lambda address: (way.index(address.partition(".")[0]), address))
        tunables = {a: b for a in own for a, b in asked.bounds(*a.split(".")).items()}
        ready = two_irises(asked, (near, far), tunables)
    except PicoError as exc:
        raise PicoError([_unfound(references, wrong) for wrong in exc.diagnostics]) from exc
    ready = replace(ready, goal=replace(ready.goal, description=one.text))
    if meant is None:
        return ready
    aim = aimed(setup, seen, ready.goal, meant)
    return replace(ready.mapped(lambda goal, former: within_reach(setup, seen, goal, former, aim)), aim=aim)


def _unfound(references: Mapping[str, LightReference], wrong: Diagnostic) -> Diagnostic:
    text = f"{', '.join(references)} can't be found by light: {wrong.summary.removeprefix(f'`{THROUGH}`: ')}"
    return error("by-light", text, hint=wrong.hint, address=next(iter(references)))


def sought_in(setup: Setup, seen: Observation, state: LabState | None) -> ByLight:
    """Return the goals that the references of a state are on the bench as `seen`, to be sought there."""
    goals = goals_of(state) if state else {}
    return reference_goals(setup, goals, seen, as_meant(setup, seen, state)) if state and goals else ByLight()


def told_of(setup: Setup, seen: Observation, state: LabState | None, *, wanted: bool = False) -> ByLight:
    """Return the same goals to say how they stand; `wanted`: once parts stand where the state wants them."""
    goals = goals_of(state) if state else {}
    if state is None or not goals:
        return ByLight()
    return reference_goals(setup, goals, _put(setup, seen, state) if wanted else as_meant(setup, seen, state))


def as_meant(setup: Setup, seen: Observation, state: LabState) -> Observation:
    """Return a bench whose parts stand exactly where a state wants them, as far as they do within tolerance."""
    parts = dict(seen.components)
    for name, part in parts.items():
        if name in setup.lab.inventory and part.presence == "seen" and part.pose is not None:
            slot, goal = place_of(setup, state, name)
            if slot is None and deviation(setup, name, part.pose, None, goal) == "tolerated":
                parts[name] = replace(part, pose=goal)
    return replace(seen, components=parts)


def _put(setup: Setup, seen: Observation, state: LabState) -> Observation:
    """Return a bench once its parts stand where a state wants them."""
    parts = {name: seen.components.get(name, ObservedComponent()) for name in setup.lab.inventory}
    stand = {n: replace(p, presence="seen", pose=place_of(setup, state, n)[1]) for n, p in parts.items()}
    return replace(seen, components={**seen.components, **stand})


def with_goals(setup: Setup, by_light: ByLight) -> Setup:
    """Return a bench whose Lab has the goals of references beside its own: for whoever asks how goals stand."""
    if not by_light.goals:
        return setup
    return replace(setup, lab=replace(setup.lab, goals={**(setup.lab.goals or {}), **by_light.goals}))
