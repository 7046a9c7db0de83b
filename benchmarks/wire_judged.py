"""What is wrong of a run through faulty wires: judged from what the journal says against what the world behind the
emulators went through."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from wire_told import Told

from pico.diagnostics import Diagnostic
from pico.edge.recovery import arrived
from pico.model.diff import value_distance
from pico.model.observation import Observation
from pico.model.operation import Operation, operation_from_json
from pico.model.setup import Setup

SAME = (1.0, 1.0)
"""How far a component may be from where it was seen [mm, deg]."""
TOLD = ("exposure", "gain")
"""What a camera is told with the next picture."""
MOST = {"home": 1, "set": 2}
"""What an operation may tell a device to do: a set-point may want its axis homed first."""


def repeated(setup: Setup, told: Sequence[Told], owners: Mapping[str, str]) -> Iterator[str]:
    """Yield what was done that was done already, and what no operation asked for; `owners`: of devices, by name."""
    open_: dict[str, Operation] = {}
    counts: dict[str, int] = {}
    for one in told:
        if one.what == "began":
            open_[one.name] = operation_from_json(one.data)
        elif one.what == "ended":
            open_.pop(one.name, None)
        elif one.what == "took":
            mine = [op for op in open_.values() if op.component == one.name and op.kind.carries]
            if not mine:
                yield f"{one.name} was taken, and no operation asked for that"
            elif arrived(setup, mine[0], one.data):
                yield f"{mine[0].id} took {one.name}, which stood where it was to bring it"
        elif one.what == "told" and not one.data.endswith(" 0"):
            keys = [k for k, op in open_.items() if op.component == owners[one.name] and op.kind.drives]
            if not keys:
                yield f"{one.name} was told {one.data!r}, and no operation asked for that"
            for key in keys[:1]:
                counts[f"{key} {one.name}"] = counts.get(f"{key} {one.name}", 0) + 1
                if counts[f"{key} {one.name}"] > MOST.get(open_[key].primitive, 1):
                    yield f"{key} told {one.name} to move {counts[f'{key} {one.name}']} times"


def unended(told: Sequence[Told]) -> Iterator[str]:
    """Yield the operations that began and have no end."""
    ended = {one.name for one in told if one.what == "ended"}
    yield from (f"{one.name} began and has no end" for one in told if one.what == "began" and one.name not in ended)


def unnamed(setup: Setup, told: Sequence[Told]) -> Iterator[str]:
    """Yield the failures of operations that do not say what failed."""
    begun = {one.name: operation_from_json(one.data) for one in told if one.what == "began"}
    for one in told:
        if one.what != "ended" or one.data.outcome == "done":
            continue
        op, why = begun.get(one.name), one.data.error
        if op is None or why is None or not (why.code == "stopped" or named(setup, (why,))):
            yield f"{one.name} failed, and of what is not said: {why}"


def named(setup: Setup, why: Sequence[Diagnostic]) -> bool:
    """Return whether each of some diagnostics names a component, robot, camera, device or safety input."""
    assert setup.wiring
    names = {*setup.lab.inventory, *setup.lab.robots, *setup.lab.cameras, *setup.wiring.devices}
    names |= set(setup.wiring.safety_inputs)
    said = (f"{d.address} {d.summary} {d.detail}" for d in why)
    return all(any(name in text for name in names) for text in said)


def misplaced(setup: Setup, told: Sequence[Told], world: Any) -> Iterator[str]:
    """Yield the components that are not where the last operation that moved or set them is said to have brought them,
    and those that lie on the table."""
    begun = {one.name: operation_from_json(one.data) for one in told if one.what == "began"}
    last: dict[str, tuple[Operation, Any]] = {}
    for one in told:
        if one.what == "ended" and one.name in begun and begun[one.name].kind.changes != "nothing":
            last[begun[one.name].address] = begun[one.name], one.data
    now = world.world()
    for name, body in now.components.items():
        if body.presence in ("toppled", "missing"):
            yield f"{name} is {body.presence}"
    for op, result in last.values():
        if result.outcome != "done" or op.component not in now.components:
            continue
        body = now.components[op.component]
        if op.kind.carries and not (body.presence == "seen" and body.pose and arrived(setup, op, body.pose)):
            yield f"{op.id} is done by the journal, and {op.component} is {body.presence} at {body.pose}"
        tunable = str(op.arguments.get("tunable"))
        if op.primitive == "set" and tunable in body.values and tunable not in TOLD:
            kind, there = setup.type_of(op.component).tunables[tunable], body.values[tunable].value
            if there is not None and value_distance(kind, there, op.arguments["to"]) > max(kind.tolerance, 0.01):
                yield f"{op.id} is done by the journal, and {op.address} is {there}"


def unseen(setup: Setup, seen: Observation, world: Any, *, parked: bool) -> Iterator[str]:
    """Yield the components of which the bench says something else than is; `parked`: no arm hides any."""
    now = world.world()
    for name, body in now.components.items():
        found = seen.components.get(name)
        if found is None or (found.presence != body.presence and not (found.presence == "missing" and not parked)):
            yield f"{name} is {body.presence}, and seen as {found.presence if found else 'nothing'}"
        elif body.presence == "seen" and body.pose and found.pose:
            off, turned = found.pose.distance(body.pose), abs((found.pose.yaw - body.pose.yaw + 180) % 360 - 180)
            if off > SAME[0] or turned > SAME[1]:
                yield f"{name} is at {body.pose}, and seen at {found.pose} ({found.how})"
        for tunable, value in (found.values if found else {}).items():
            is_ = body.values[tunable].value if tunable in body.values else None
            kind = setup.type_of(name).tunables[tunable]
            if tunable in TOLD or value.status != "known" or is_ is None or value.value is None:
                continue
            if value_distance(kind, value.value, is_) > max(kind.tolerance, 0.01):
                yield f"{name}.{tunable} is {is_}, and read as {value.value}"
