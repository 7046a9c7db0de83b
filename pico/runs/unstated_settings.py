"""Settings that PICO made and that no state names: comparing states does not show them."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.diagnostics import PicoError
from pico.model.catalog import Tunable
from pico.model.comparing.unstated import Unstated
from pico.model.diff import show_value, value_deviation
from pico.model.observation import Observation
from pico.model.operation import Operation, touched_by
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.planning.parts.phrases import listed

if TYPE_CHECKING:
    from pico.runs.memory import Memory

_SET = ("set", "optimize", "teleoperate")
"""Primitives that set tunables."""


def unstated_settings(
    setup: Setup, memory: Memory | None, seen: Observation, *states: LabState | None, since: datetime | None = None
) -> dict[str, Value]:
    """Return the live values of the tunables that operations set on this bench and that none of `states` names, by
    address, sorted.

    Light that is asked for is not among them, nor what is back at the value before the first operation on it. `since`:
    only what was set at that time or later. Raises PicoError if the journal can't be read.
    """
    live = _unnamed(setup, seen, states)
    if not live or memory is None:
        return {}
    first: dict[str, Any] = {}
    recent = set[str]()
    for success in memory.successes({address.partition(".")[0] for address in live}):
        operation = success.operation
        if operation.primitive not in _SET:
            continue
        for address in {f"{c}.{t}" for c, t in touched_by(operation.component, operation.arguments)} & live.keys():
            before = _before(operation, address)
            if before is None and operation.reason.kind == "interlock":
                continue  # set for a measurement, from a value that nothing could restore
            first[address] = before
            if since is None or clock.parse(success.at) >= since:
                recent.add(address)
    return {a: live[a] for a in sorted(recent) if _differs(setup, a, live[a], first[a])}


def looked_up(
    setup: Setup, memory: Memory | None, seen: Observation, *states: LabState | None
) -> dict[str, Value]:  # fmt: skip
    """Return `unstated_settings`; nothing if the journal can't be read, for a command that only looks."""
    try:
        return unstated_settings(setup, memory, seen, *states)
    except PicoError:
        return {}


def tell(
    setup: Setup, memory: Memory | None, seen: Observation, *states: LabState | None
) -> tuple[Unstated, ...]:  # fmt: skip
    """Return `looked_up` with units, for what compares the bench with a state."""
    found = looked_up(setup, memory, seen, *states)
    return tuple(Unstated(address=a, value=value, unit=_kind(setup, a).unit) for a, value in found.items())


def in_words(setup: Setup, settings: Mapping[str, Value]) -> str:
    """Return settings with their values: `camera.exposure 7 ms and m.tip 0.5 mrad`."""
    return listed([f"{a} {show_value(v)} {_kind(setup, a).unit}".rstrip() for a, v in settings.items()])


def _unnamed(setup: Setup, seen: Observation, states: tuple[LabState | None, ...]) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for name, values in seen.known_values.items():
        kinds = setup.type_of(name).tunables if name in setup.lab.inventory else {}
        named = {t for one in states if one and name in one.components for t in one.components[name].given}
        own = [t for t in values if t in kinds and t not in named and not setup.requests(name, t)]
        found |= {f"{name}.{t}": values[t] for t in own}
    return found


def _before(operation: Operation, address: str) -> Any:
    """Return the value that an operation found."""
    begun = operation.arguments.get("from")
    return begun.get(address) if isinstance(begun, Mapping) else begun


def _differs(setup: Setup, address: str, value: Value, before: Any) -> bool:
    return before is None or value_deviation(_kind(setup, address), value, before) == "off"


def _kind(setup: Setup, address: str) -> Tunable:
    component, _, tunable = address.partition(".")
    return setup.type_of(component).tunables[tunable]
