"""Lasers are shut while somebody works in the beam, or an axis that steers it is homed; they open when all is done. The
lamps of the room are on while an arm works: cameras see by them. `pico.planning.passes.interlocks` makes a plan so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pico.diagnostics import Diagnostic, error, warning
from pico.model.arming import LaserClass
from pico.model.catalog import Tunable
from pico.model.observation import Observation, ObservedValue
from pico.model.operation import Operation, Reason, new_id
from pico.model.quantities import Value
from pico.model.setpoint import set_seconds
from pico.model.setup import Setup
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.emission import unlicensed
from pico.planning.parts.phrases import listed

STEERING = (
    "beam_splitter", "expander", "grating", "lens", "mirror", "plate_splitter", "prism", "retroreflector",
    "roof_mirror", "waveplate", "wollaston",
)  # fmt: skip
"""Elements that send the beam elsewhere while their axes are homed; a wave plate does so through a polarizing splitter
behind it. A polarizer only dims it."""
OPEN, CLOSED = "open", "closed"
LAMP = "illumination"
"""The tunable of a lamp that lights the room."""


@dataclass(frozen=True, slots=True)
class Gate:
    """What is at one value while somebody works: the shutter of a laser, its own or one on the table (`component`), or
    a lamp; what it was seen at (None where nobody knows), and what it is to be at in the end."""

    laser: str
    component: str
    kind: Tunable
    live: Value | None
    goal: Value | None
    tunable: str = "shutter"
    working: Value = CLOSED


def stay_shut(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> dict[str, LaserClass]:
    """Return the lasers that are open now, and that the interlocks of these operations shut for good, for nobody lets
    them emit; each with its class."""
    if not in_beam(setup, operations) or setup.lab.policy.open_beam:
        return {}
    found: dict[str, LaserClass] = {}
    for shutter in shutters(setup, seen, operations):
        found |= stays_shut(setup, seen, operations, shutter) if shutter.goal != CLOSED else {}
    return found


def stays_shut(
    setup: Setup, seen: Observation, operations: Sequence[Operation], gate: Gate
) -> dict[str, LaserClass]:  # fmt: skip
    """Return the lasers that a gate would let out again and nobody lets emit, each with its class."""
    if gate.goal is None or gate.goal == CLOSED:
        return {}
    return unlicensed(setup, seen, [*operations, set_gate(gate, CLOSED, gate.goal, "")])


def lamps(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> Iterator[Gate]:
    """Yield the lamps that a plan can turn on, by name."""
    for name in sorted(setup.lab.inventory):
        kind, part = setup.type_of(name).tunables.get(LAMP), seen.components.get(name)
        if kind is not None and kind.mover in ("motor", "electronics") and part is not None and LAMP in part.values:
            yield _gate(operations, "", name, kind, part.values[LAMP], LAMP, True)


def _gate(
    operations: Sequence[Operation], laser: str, name: str, kind: Tunable, known: ObservedValue, tunable: str,
    working: Value,
) -> Gate:  # fmt: skip
    live = known.value if known.status == "known" else None
    ends = [o.arguments.get("to") for o in operations if sets(o, name, tunable)]
    return Gate(laser, name, kind, live, ends[-1] if ends else known.value, tunable, working)


def in_beam(setup: Setup, operations: Sequence[Operation]) -> list[Operation]:
    """Return the operations that want the beam blocked: those of arms and people, and homing what steers it."""
    return [o for o in operations if _works(o) or (o.primitive == "home" and _steers(setup, o))]


def _works(operation: Operation) -> bool:
    """Whether somebody reaches over the table."""
    return operation.robot is not None or operation.kind.by_hand


def _steers(setup: Setup, operation: Operation) -> bool:
    return setup.type_of(operation.component).optics.element in STEERING


def why_shut(guarded: Sequence[Operation]) -> str:
    """Return in words why beams are shut for operations."""
    who = sorted({o.robot or "" for o in guarded} - {""})
    who += ["a person"] if any(o.kind.by_hand for o in guarded) else []
    if who:
        return f"{listed(who)} {'works' if len(who) == 1 else 'work'} in the beam"
    names = [f"{o.component}.{o.arguments['tunable']}" for o in guarded]
    return f"homing {', '.join(names)} steers the beam"


def shutters(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> Iterator[Gate]:
    """Yield what closes each laser that a plan can close, by name: its own shutter, else one in its beam."""
    taken = set[str]()
    for laser in _lasers(setup):
        found = _shutter(setup, seen, operations, laser, laser)
        if found is None and (other := shutter_of(setup, seen, operations, laser)):
            found = _shutter(setup, seen, operations, laser, other)
        if found and found.component not in taken:
            taken.add(found.component)
            yield found


def _shutter(
    setup: Setup, seen: Observation, operations: Sequence[Operation], laser: str, name: str
) -> Gate | None:  # fmt: skip
    kind, part = setup.type_of(name).tunables.get("shutter"), seen.components.get(name)
    if kind is None or part is None or "shutter" not in part.values or not _closes(kind):
        return None
    return _gate(operations, laser, name, kind, part.values["shutter"], "shutter", CLOSED)


def _lasers(setup: Setup) -> list[str]:
    return [n for n in sorted(setup.lab.inventory) if setup.type_of(n).optics.element == "source"]


def _closes(kind: Tunable) -> bool:
    return kind.mover in ("motor", "electronics") and {OPEN, CLOSED} <= set(kind.choices)


def sets(operation: Operation, name: str, tunable: str = "shutter") -> bool:
    """Whether an operation sets a tunable of a component."""
    own = operation.arguments.get("tunable")
    return operation.primitive == "set" and operation.component == name and own == tunable


def set_gate(gate: Gate, before: Value | None, after: Value, why: str) -> Operation:
    """Return an operation that sets a gate."""
    return Operation(
        id=new_id(), primitive="set", component=gate.component, reason=Reason(kind="interlock", text=why),
        arguments={"tunable": gate.tunable, "from": before, "to": after},
        resources=(f"{gate.component}.{gate.tunable}", gate.component), seconds=set_seconds(gate.kind, before, after),
    )  # fmt: skip


def unguarded(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> list[Diagnostic]:
    """Return an error for each shutter that would open while a robot holds something over the table, and a warning for
    each laser whose beam nothing closes while somebody works in it."""
    if setup.lab.policy.open_beam:
        return []
    held = [*_opened_over_a_hand(setup, seen, operations)]
    if held or not in_beam(setup, operations):
        return held
    closed = {s.laser for s in shutters(setup, seen, operations)}
    why = why_shut(in_beam(setup, operations))
    return [
        warning(
            "open-beam", f"no operation can close the beam of {laser} while {why}",
            hint="block it by hand; a lab where the beam may stay open says `policy: {open_beam: true}`", address=laser,
        )
        for laser in _lasers(setup)
        if laser not in closed and laser in seen.components and seen.components[laser].presence != "missing"
    ]  # fmt: skip


def _opened_over_a_hand(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> Iterator[Diagnostic]:
    closing = {*_lasers(setup), *(s.component for s in shutters(setup, seen, operations))}
    for robot, hand in sorted(seen.robots.items()):
        for laser in sorted(closing):
            if hand.holding and any(sets(o, laser) and o.arguments["to"] == OPEN for o in operations):
                text = f"the shutter of {laser} stays closed while {robot} holds {hand.holding}"
                hint = f"take {hand.holding} out of the gripper and set it down, on the simulated bench with "
                hint += f"`pico sim nudge {hand.holding}`; then plan again"
                yield error("hand-full", text, hint=hint, address=f"{laser}.shutter")


def policy_rules(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> tuple[Mapping[str, Any], ...]:
    """Return what `Plan.policy` says of a plan's lasers: each rule with whether it holds, and in words."""
    count = sum(not o.kind.parks for o in in_beam(setup, operations))
    lasers = [s.component for s in shutters(setup, seen, operations)]
    if not count or not lasers:
        return ()
    when = f"during {count} move{'' if count == 1 else 's'}"
    names = f"{listed(lasers)} shutter{'' if len(lasers) == 1 else 's'}"
    if setup.lab.policy.open_beam:
        return ({"rule": "open_beam", "holds": True, "text": f"open beam allowed {when}"},)
    return ({"rule": "closed_beam", "holds": True, "text": f"{names} closed {when}"},)
