"""An optimization as an operation: what its measurements need is set first, and set back when it is done."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.model.lab import EXPOSURE, Goal, Setup
from pico.model.observation import Observation, astray
from pico.model.operation import Operation, Reason
from pico.model.quantities import Value
from pico.model.setpoint import set_seconds
from pico.model.vocabulary import measured_in
from pico.motion.types import Motion
from pico.optimize.registry import algorithm_file
from pico.planning.measuring import granted, kept_shut, needed, setting
from pico.planning.parts.setdown import park_operation
from pico.planning.sought import Sought, arguments_of

if TYPE_CHECKING:
    from pico.optics.nominal.feeding import Right

TAKES = 0.6
"""What a measurement takes, with the table at rest [s]."""
ASKED = Reason(kind="asked")


def optimizing(
    setup: Setup, seen: Observation, one: Sought, motion: Motion | None, first: Sequence[Sought] = (),
    reason: Reason = ASKED, right: Sequence[Right] = (),
) -> list[Operation]:  # fmt: skip
    """Return the operations that bring light to a goal: arms that stand out park, what is measured gets what it needs,
    its tunables make up for how parts stand otherwise than where light was `right`, in the first of these that is this
    bench still, the optimization, and all is set back. `after` holds indices as text. `first`: goals that are sought
    before it where it is dark, in the same operation.

    Raises PicoError where a tunable of a goal is not known, so that nobody could go back to it.
    """
    name, stages = one.name, (*first, one)
    begin = {a: v for stage in stages for a, v in _from(setup, seen, stage.name, stage.goal).items()}
    only = {a: v for stage in stages for a, v in _to_measure(setup, seen, stage.goal).items() if a not in begin}
    out = [park_operation(setup, seen, robot, (), motion) for robot in astray(setup, seen)]
    parks = [*map(str, range(len(out)))]
    measured = dict.fromkeys(m for stage in stages for m in measured_in(setup, stage.goal.texts))
    wants = {
        need.address: need
        for component, measurable in measured
        for need in granted(setup, seen, needed(setup, seen, component, setup.measurables_of(component)[measurable]))
        if need.live != need.value or (parks and need.opens)
    }
    for need in wants.values():
        waits = parks if need.opens else []
        out.append(setting(setup, need, need.live, need.value, waits, f"to measure for {name}"))
    made_up = (absorbed(setup, seen, one.goal, bench) for bench in right)
    fed = next((found for found in made_up if found is not None), {})
    for address, value in fed.items():
        out.append(_absorbing(setup, address, begin[address], value, parks))
    begin |= fed
    parts = sorted({address.partition(".")[0] for address in begin})
    looked = {a for stage in stages for settings in (stage.goal.looks or {}).values() for a in settings}
    detectors = sorted({component for component, _ in measured} | {a.partition(".")[0] for a in looked})
    out.append(Operation(
        id="", primitive="optimize", component=parts[0], reason=reason, after=tuple(map(str, range(len(out)))),
        arguments={"from": {**begin, **only}, "specimens": specimens(setup), **arguments_of(setup, one, first)},
        resources=tuple(dict.fromkeys((*begin, *sorted(looked), *parts, *detectors, *sorted(setup.lab.robots)))),
        seconds=sum(seconds(setup, stage.goal, stage.algorithm) for stage in stages),
    ))  # fmt: skip
    done = str(len(out) - 1)
    for need in wants.values():
        if need.live is not None and need.live != need.value and not kept_shut(setup, seen, need):
            text = f"as it was before {name}"
            out.append(setting(setup, need, need.value, need.live, [done], text))
    return out


def absorbed(setup: Setup, seen: Observation, goal: Goal, right: Right) -> dict[str, float] | None:
    """Return what tunables of a goal are to be set to first, so that they make up for how parts stand otherwise than
    where light was right: within the goal's bounds, and within the trim of each around where it was. None where nobody
    can tell."""
    from pico.optics.nominal.feeding import fed_forward

    limits = {}
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        restore = setup.type_of(component).tunables[tunable].restore
        part = right.state.components.get(component)
        was = part.values.get(tunable) if part else None
        if restore.kind == "align" and restore.trim is not None and isinstance(was, int | float):
            low, high = max(low, was - restore.trim), min(high, was + restore.trim)
        limits[address] = (low, high)
    if any(low >= high for low, high in limits.values()):
        return None
    return fed_forward(setup, seen, goal, right, limits)


def _absorbing(setup: Setup, address: str, before: float, after: float, waits: Sequence[str]) -> Operation:
    component, _, tunable = address.partition(".")
    return Operation(
        id="", primitive="set", component=component, reason=Reason(kind="asked", text="makes up for how parts stand"),
        arguments={"tunable": tunable, "from": before, "to": after}, after=tuple(waits),
        resources=(address, component), seconds=set_seconds(setup.type_of(component).tunables[tunable], before, after),
    )  # fmt: skip


def specimens(setup: Setup) -> Mapping[str, str]:
    """Return the serial numbers of the parts that have one: what light was brought to a goal with."""
    return {name: part.serial for name, part in sorted(setup.lab.inventory.items()) if part.serial}


def seconds(setup: Setup, goal: Goal, algorithm: str) -> float:
    """Return what an optimization takes [s] as a plan reckons it: the usual number of measurements, each after a step
    of an eighth of the range of the slowest tunable."""
    steps = []
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables[tunable]
        steps.append(set_seconds(kind, low, low + (high - low) / 8))
    usual = algorithm_file(algorithm).DECLARATION.usual
    many = max(1, len(goal.looks or ())) * len(measured_in(setup, goal.texts))
    return min(goal.budget.seconds, min(usual, goal.budget.measurements) * (max(steps) + many * TAKES))


def _to_measure(setup: Setup, seen: Observation, goal: Goal) -> Mapping[str, Value]:
    """Return what may be set on the way only to be measured by, as it is, by address: the exposures of detectors, and
    what looks set."""
    looked = {address for settings in (goal.looks or {}).values() for address in settings}
    exposed = {f"{c}.{EXPOSURE}" for c, _ in measured_in(setup, goal.texts) if setup.ranges(c)}
    found = dict[str, Value]()
    for address in sorted(looked | exposed):
        component, _, tunable = address.partition(".")
        part = seen.components.get(component)
        live = part.values.get(tunable) if part else None
        if live is not None and live.status != "unknown" and live.value is not None:
            found[address] = live.value
        elif address in looked:
            text = f"nobody knows {address}, so that nobody could set it back"
            raise PicoError(error("goal", text, hint=f"`pico set {address} VALUE` first", address=address))
    return found


def _from(setup: Setup, seen: Observation, name: str, goal: Goal) -> Mapping[str, float]:
    found = {}
    for address in goal.tunables:
        component, _, tunable = address.partition(".")
        part = seen.components.get(component)
        live = part.values.get(tunable) if part is not None and part.presence == "seen" else None
        if live is None or live.status == "unknown" or not isinstance(live.value, int | float):
            hint = f"`pico do {component} home {tunable}` finds out" if part is not None else ""
            text = f"nobody knows {address}, so that nobody could go back to it"
            raise PicoError(error("goal", text, hint=hint, address=address))
        found[address] = float(live.value)
        low, high = goal.tunables[address]
        if not low <= live.value <= high:
            text = f"{address} stands at {live.value:g}, outside {low:g} to {high:g}, within which {name} is sought"
            near = low if live.value < low else high
            raise PicoError(error("goal", text, hint=f"`pico set {address} {near:g}` brings it there", address=address))
    return found
