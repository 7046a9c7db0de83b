"""An optimization as an operation: what its measurements need is set first, and set back when it is done."""

from __future__ import annotations

from collections.abc import Mapping

from pico.diagnostics import PicoError, error
from pico.model.lab import EXPOSURE, Goal, Setup
from pico.model.observation import Observation, astray
from pico.model.operation import Operation, Reason
from pico.model.record import as_json
from pico.model.setpoint import set_seconds
from pico.model.vocabulary import measured_in
from pico.motion.types import Motion
from pico.optimize.choosing import Tuned, choose, usual_parameters
from pico.optimize.registry import algorithm_file
from pico.planning.measuring import needed, setting
from pico.planning.parts.setdown import park_operation

TAKES = 0.6
"""What a measurement takes, with the table at rest [s]."""
ASKED = Reason(kind="asked")


def optimizing(
    setup: Setup, seen: Observation, name: str, goal: Goal, algorithm: str, motion: Motion | None,
    reason: Reason = ASKED,
) -> list[Operation]:  # fmt: skip
    """Return the operations that bring light to a goal: arms that stand out park, what is measured gets what it needs,
    the optimization, and all is set back. `after` holds indices as text.

    Raises PicoError where a tunable of the goal is not known, so that nobody could go back to it.
    """
    begin = {**_from(setup, seen, name, goal), **_exposures(setup, seen, goal)}
    given = {**usual_parameters(algorithm, _tuned(setup, goal)), **(goal.parameters or {})}
    out = [park_operation(setup, seen, robot, (), motion) for robot in astray(setup, seen)]
    parks = [*map(str, range(len(out)))]
    wants = {
        need.address: need
        for component, measurable in measured_in(setup, goal.texts)
        for need in needed(setup, seen, component, setup.measurables_of(component)[measurable])
        if need.live != need.value or (parks and need.opens)
    }
    for need in wants.values():
        waits = parks if need.opens else []
        out.append(setting(setup, need, need.live, need.value, waits, f"to measure for {name}"))
    parts = sorted({address.partition(".")[0] for address in goal.tunables})
    detectors = sorted({component for component, _ in measured_in(setup, goal.texts)})
    out.append(Operation(
        id="", primitive="optimize", component=parts[0], reason=reason, after=tuple(map(str, range(len(out)))),
        arguments={"goal": name, "from": begin, "algorithm": algorithm, "parameters": given, **as_json({"what": goal})},
        resources=tuple(dict.fromkeys((*goal.tunables, *parts, *detectors, *sorted(setup.lab.robots)))),
        seconds=seconds(setup, goal, algorithm),
    ))  # fmt: skip
    done = str(len(out) - 1)
    for need in wants.values():
        if need.live is not None and need.live != need.value:
            text = f"as it was before {name}"
            out.append(setting(setup, need, need.value, need.live, [done], text))
    return out


def seconds(setup: Setup, goal: Goal, algorithm: str) -> float:
    """Return what an optimization takes [s] as a plan reckons it: the usual number of measurements, each after a step
    of an eighth of the range of the slowest tunable."""
    steps = []
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables[tunable]
        steps.append(set_seconds(kind, low, low + (high - low) / 8))
    usual = algorithm_file(algorithm).DECLARATION.usual
    many = len(measured_in(setup, goal.texts))
    return min(goal.budget.seconds, min(usual, goal.budget.measurements) * (max(steps) + many * TAKES))


def algorithm_for(setup: Setup, goal: Goal) -> tuple[str, str]:
    """Return the algorithm that suits a goal, and why."""
    kernels = []
    for text in goal.reach or (goal.texts[0],):
        of = measured_in(setup, [text])
        kernel = setup.measurables_of(of[0][0])[of[0][1]].kernel if of else None
        kernels.append((kernel or "").rpartition("|")[2].strip().partition("(")[0])
    return choose(_tuned(setup, goal), kernels, goal.aim)


def _tuned(setup: Setup, goal: Goal) -> list[Tuned]:
    found = []
    for address in goal.tunables:
        component, _, name = address.partition(".")
        kind = setup.type_of(component)
        found.append(Tuned(kind.optics.element, name, kind.tunables[name].period))
    return found


def _exposures(setup: Setup, seen: Observation, goal: Goal) -> Mapping[str, float]:
    """Return the exposures, by address, that a detector may be given on the way, as they are."""
    found = {}
    for component, _ in measured_in(setup, goal.texts):
        part = seen.components.get(component)
        live = part.values.get(EXPOSURE) if part and setup.ranges(component) else None
        if live is not None and live.status != "unknown" and isinstance(live.value, int | float):
            found[f"{component}.{EXPOSURE}"] = float(live.value)
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
