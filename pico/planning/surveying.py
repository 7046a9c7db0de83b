"""A survey as an operation: tunables are set to a few points each and read there, by motors alone, and set back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.diagnostics import PicoError
from pico.model.observation import Observation, astray
from pico.model.operation import Operation, Reason, new_id
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setpoint import set_seconds
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.measuring import granted, kept_shut, measuring, needed, setting
from pico.planning.parts.setdown import park_operation
from pico.planning.unknown_values import unknown_start

TAKES = 0.6
"""What a measurement takes [s]."""
Shots = Sequence[tuple[str, Mapping[str, Value]]]
"""What is measured (`cam.power`), with tunables set at other values than they stand at, by address."""


def surveying(
    setup: Setup, seen: Observation, shots: Shots, dark: Sequence[str], motion: Motion | None
) -> list[Operation]:
    """Return the operations of a survey: arms that stand out park, what is measured gets what it needs, all is read and
    set back; frames in the `dark` of cameras come last.

    Raises PicoError if a tunable that is to be set is not known, for it is set back.
    """
    begin = {a: _known(setup, seen, a) for a in sorted({a for _, at in shots for a in at})}
    out = [park_operation(setup, seen, robot, (), motion) for robot in astray(setup, seen)]
    parks = [op.id for op in out]
    wants = {
        need.address: need
        for component, _, measurable in (address.partition(".") for address, _ in shots)
        for need in granted(setup, seen, needed(setup, seen, component, setup.measurables_of(component)[measurable]))
        if need.live != need.value
    }
    for need in wants.values():
        out.append(setting(setup, need, need.live, need.value, parks if need.opens else [], "to measure"))
    if shots:
        out.append(_survey(setup, shots, begin, [op.id for op in out]))
    done = [op.id for op in out[-1:]]
    for need in wants.values():
        if need.live is not None:
            out.append(setting(setup, need, need.value, need.live, done, "as it was before"))
    before = tuple(op.id for op in out)
    wanted = [(name, "dark") for name in dark if not shuts_for_good(setup, seen, name)]
    parked = replace(seen, robots={})
    measured = measuring(setup, parked, wanted, Reason(kind="asked"), None)
    return [*out, *(replace(op, after=(*before, *op.after)) for op in measured)]


def shuts_for_good(setup: Setup, seen: Observation, camera: str) -> bool:
    """Return whether a frame in the dark would shut a laser that nobody lets emit again."""
    needs = needed(setup, seen, camera, setup.measurables_of(camera)["dark"])
    return any(kept_shut(setup, seen, need) for need in needs if need.live != need.value)


def _survey(setup: Setup, shots: Shots, begin: Mapping[str, float], after: Sequence[str]) -> Operation:
    detectors = sorted({address.partition(".")[0] for address, _ in shots})
    parts = sorted({address.partition(".")[0] for address in begin})
    reached = {a: [v, *(float(at[a]) for _, at in shots if a in at)] for a, v in begin.items()}
    bounds = {a: [min(values), max(values)] for a, values in reached.items()}
    what: dict[str, Any] = {"tunables": bounds, "shots": [{"address": a, "at": dict(at)} for a, at in shots]}
    return Operation(
        id=new_id(), primitive="survey", component=(parts or detectors)[0], reason=Reason(kind="asked"),
        after=tuple(after), arguments={"from": dict(begin), **as_json({"what": what})},
        resources=tuple(dict.fromkeys((*begin, *parts, *detectors, *sorted(setup.lab.robots)))),
        seconds=seconds(setup, shots, begin),
    )  # fmt: skip


def seconds(setup: Setup, shots: Shots, begin: Mapping[str, float]) -> float:
    """Return what a survey takes [s]: each setting, what it waits for, and each measurement."""
    stands, total = dict(begin), 0.0
    for _, at in shots:
        for address, value in {**begin, **at}.items():
            if stands[address] != value:
                component, _, tunable = address.partition(".")
                total += set_seconds(setup.type_of(component).tunables[tunable], stands[address], value)
                stands[address] = float(value)
        total += TAKES
    return total


def _known(setup: Setup, seen: Observation, address: str) -> float:
    component, _, tunable = address.partition(".")
    live = seen.components[component].values.get(tunable)
    if live is None or live.status == "unknown" or not isinstance(live.value, int | float):
        raise PicoError(unknown_start(setup, address, "survey"))
    return float(live.value)
