"""The goals that set-points found by light are: which tunables are searched, what is measured, and where.

`reference_goals` is the one way from a reference to a goal. It is pure: the same references, poses and values give the
same goals, each named after its address (`p2.angle`), so whoever compiles a plan seeks them like goals of the Lab:
`optimizing(setup, seen, address, goals[address], algorithm_for(setup, goals[address])[0], motion)`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from pico.diagnostics import Diagnostic, error
from pico.model.lab import Goal, Setup
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.state import NULL, LabState, LightReference, place_of, references_of
from pico.model.vocabulary import numbers_of
from pico.optics.axis import Meeting, Values, beams

POWERS = ("power", "voltage")
"""The numbers of a detector that tell how much light comes to it."""
WITHIN = 0.2
"""How well a place is to be known that light finds, as a share of the tolerance of its tunable."""


@dataclass(frozen=True)
class ByLight:
    """The goals of references by address, and of those that can't be sought why not."""

    goals: Mapping[str, Goal] = field(default_factory=dict)
    wrong: tuple[Diagnostic, ...] = ()


def reference_goals(
    setup: Setup, references: Mapping[str, LightReference], poses: Mapping[str, Pose], values: Values
) -> ByLight:
    """Return the goals that references (by address) are, with parts standing at `poses` [mm, deg] and tunables at
    `values` in the units of the catalog; `wrong`: those whose light does not come by, each with its address."""
    if not references:
        return ByLight()
    standing = {name: pose for name, pose in poses.items() if name in setup.lab.inventory}
    ways = tuple(_ways(setup, standing, values))
    goals: dict[str, Goal] = {}
    wrong: list[Diagnostic] = []
    for address, one in references.items():
        found = _null(setup, address, one, ways) if one.kind == NULL else _through(address)
        if isinstance(found, Goal):
            goals[address] = found
        else:
            wrong.append(found)
    return ByLight(goals, tuple(wrong))


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
    return next((f"{name}.{number}" for number in POWERS if number in numbers), "")


def _null(
    setup: Setup, address: str, one: LightReference, ways: Sequence[tuple[Meeting, ...]]
) -> Goal | Diagnostic:  # fmt: skip
    component, _, tunable = address.partition(".")
    wanted = dict.fromkeys((*one.parts, component))
    if why := _astray(address, tuple(wanted), ways):
        return why
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


def _through(address: str) -> Diagnostic:
    text = f"{address} can't be sought yet: this PICO does not bring beams through two irises by itself"
    return error("by-light", text, hint="give it a number", address=address)


def sought_in(setup: Setup, seen: Observation, state: LabState | None, *, wanted: bool = False) -> ByLight:
    """Return the goals that the references of a state are on the bench as `seen`; `wanted`: once its parts stand where
    the state wants them."""
    references = references_of(state) if state else {}
    if state is None or not references:
        return ByLight()
    poses = {n: p.pose for n, p in seen.components.items() if p.presence == "seen" and p.pose is not None}
    if wanted:
        poses |= {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    return reference_goals(setup, references, poses, seen.known_values)


def with_goals(setup: Setup, by_light: ByLight) -> Setup:
    """Return a bench whose Lab has the goals of references beside its own: for whoever asks how goals stand."""
    if not by_light.goals:
        return setup
    return replace(setup, lab=replace(setup.lab, goals={**(setup.lab.goals or {}), **by_light.goals}))
