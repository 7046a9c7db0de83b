"""Operations that drive motors and set-points; they run beside the arm."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from pico.diagnostics import Diagnostic, warning
from pico.model.catalog import Tunable
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason, new_id
from pico.model.quantities import Value
from pico.model.setpoint import home_seconds, set_seconds
from pico.model.setup import Setup
from pico.model.state import references_of
from pico.planning.passes.draft import Draft

OPERATOR_SECONDS = 60.0
"""What a plan reckons with for something that a person does by hand [s]."""
UNKNOWN = "nobody knows where its axis is"


def values_set(draft: Draft) -> Draft:
    """Return the plan with what sets every tunable that differs and is asked for, and homes the axes of those that
    light is to find."""
    chosen, goal = draft.only.chosen, draft.goal
    asked = [
        c for c in draft.changes if chosen(c.component, c.tunable) and (c.component, c.tunable) not in draft.withheld
    ]
    made, notes = value_operations(draft.setup, draft.seen, asked, goal.reason)
    referred = [address for address in references_of(goal.wanted) if chosen(*address.split("."))]
    homed = homing(draft.setup, draft.seen, referred)
    return replace(draft, operations=(*draft.operations, *made, *homed)).told(*notes)


def value_operations(
    setup: Setup, seen: Observation, changes: Sequence[Change], reason: Reason | None = None
) -> tuple[list[Operation], list[Diagnostic]]:
    """Return the operations that bring every tunable other than a pose to its value, homing first where nobody knows
    where a homed axis stands."""
    operations: list[Operation] = []
    found: list[Diagnostic] = []
    for change in changes:
        if change.tunable == "pose" or change.tolerated:
            continue
        kind = setup.type_of(change.component).tunables[change.tunable]
        why = reason or Reason(kind="changed", text=change.text)
        if kind.mover in ("motor", "electronics"):
            operations += _drive(seen, change, kind, why)
        elif kind.mover == "none":
            found.append(warning(
                "unsupported", f"nothing moves {change.tunable} of {change.component} ({change.text})",
                hint="its type says `mover: none`", address=f"{change.component}.{change.tunable}",
            ))  # fmt: skip
        else:
            operations.append(_by_hand(setup, change))
    return operations, found


def homing(setup: Setup, seen: Observation, addresses: Collection[str]) -> Iterator[Operation]:
    """Yield the homing of those axes that can be homed of which nobody knows where they stand."""
    for component, _, tunable in (address.partition(".") for address in addresses):
        kind, part = setup.type_of(component).tunables[tunable], seen.components.get(component)
        live = part.values.get(tunable) if part is not None and part.presence == "seen" else None
        if live is not None and live.status == "unknown" and kind.axis is not None and kind.axis.kind == "homed":
            yield home_operation(component, tunable, kind, None, Reason(kind="changed", text=UNKNOWN))


def _drive(seen: Observation, change: Change, kind: Tunable, reason: Reason) -> Iterator[Operation]:
    name, tunable = change.component, change.tunable
    resource = f"motor/{name}.{tunable}" if kind.mover == "motor" else f"{name}.{tunable}"
    live = seen.components[name].values[tunable]
    homing = live.status == "unknown" and kind.axis is not None and kind.axis.kind == "homed"
    before: Value | None = change.before
    after: tuple[str, ...] = ()
    if homing and kind.axis:
        home = home_operation(name, tunable, kind, None, Reason(kind=reason.kind, text=UNKNOWN))
        before, after = kind.axis.home, (home.id,)
        yield home
    yield Operation(
        id=new_id(), primitive="set", component=name,
        arguments={"tunable": tunable, "from": before, "to": change.after}, resources=(resource, name), after=after,
        reason=reason, seconds=set_seconds(kind, before, change.after),
    )  # fmt: skip


def home_operation(name: str, tunable: str, kind: Tunable, live: Value | None, reason: Reason) -> Operation:
    """Return the operation that homes the axis of a tunable."""
    return Operation(
        id=new_id(), primitive="home", component=name, arguments={"tunable": tunable},
        resources=(f"motor/{name}.{tunable}", name), reason=reason, seconds=home_seconds(kind, live),
    )  # fmt: skip


def hands_of(setup: Setup) -> tuple[str, ...]:
    """Return what a step by hand keeps busy beside its part: all arms, for a person works where none moves; in a lab
    without arms the person, who does one step after the other."""
    return tuple(sorted(setup.lab.robots)) or ("person",)


def _by_hand(setup: Setup, change: Change) -> Operation:
    text = f"set {change.tunable} of {change.component}: {change.text}"
    return Operation(
        id=new_id(), primitive="operator", component=change.component,
        arguments={"text": text, "tunable": change.tunable, "to": change.after},
        resources=(change.component, *hands_of(setup)),
        reason=Reason(kind="operator", text="only a person can do this"), seconds=OPERATOR_SECONDS,
    )  # fmt: skip
