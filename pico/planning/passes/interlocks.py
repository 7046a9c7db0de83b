"""Shutters closed before somebody works in a beam, lamps on while an arm works, and both as wanted afterwards."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

from pico.model.operation import Operation
from pico.model.quantities import Value
from pico.planning.checks.interlocks import Gate, in_beam, lamps, set_gate, sets, shutters, stays_shut, why_shut
from pico.planning.passes.draft import Draft


def interlocked(draft: Draft) -> Draft:
    """Return the plan with more operations where shutters must be closed first and opened again at the end, and with
    the edges that this takes. A shutter ends as the operations of the plan leave it.

    What sets a shutter comes after the moves themselves, not only after the park: where a move fails, an arm still
    parks, but nobody knows what stands in the beam, and the shutter stays closed. That of a laser which nobody lets
    emit stays closed in the end, too.
    """
    bench = (draft.setup, draft.seen, draft.operations)
    out = {op.id: op for op in draft.operations}
    arms = [op for op in draft.operations if op.robot is not None]
    for lamp in lamps(*bench) if arms else ():
        _keep(out, lamp, arms, "the cameras of the arm see by it", "on while an arm worked")
    guarded = in_beam(draft.setup, draft.operations)
    for shutter in shutters(*bench) if guarded and not draft.setup.lab.policy.open_beam else ():
        gate = replace(shutter, goal=None) if stays_shut(*bench, shutter) else shutter
        _keep(out, gate, guarded, why_shut(guarded), f"closed while {why_shut(guarded)}")
    return replace(draft, operations=tuple(out.values()))


def _keep(out: dict[str, Operation], gate: Gate, guarded: Sequence[Operation], why: str, was: str) -> None:
    """Let a gate be at its working value while the guarded operations go on, and as it is to be after them."""
    first, last = _ends(guarded)
    _close(out, gate, first, guarded, why)
    _set_back(out, gate, last, was)


def _ends(guarded: Sequence[Operation]) -> tuple[list[str], list[str]]:
    """Return which of the guarded operations wait for none of them, and which none but a park waits for."""
    inside = {o.id for o in guarded}
    waited = {e for o in guarded if not o.kind.parks for e in o.after}
    return [o.id for o in guarded if inside.isdisjoint(o.after)], [o.id for o in guarded if o.id not in waited]


def _close(
    out: dict[str, Operation], gate: Gate, first: Sequence[str], guarded: Sequence[Operation], why: str
) -> None:  # fmt: skip
    """Let the first of the guarded operations come after the gate is as it must be, by what the plan holds or more."""
    if gate.live == gate.working:
        return
    closing = _setting(out, gate, gate.working) or set_gate(gate, gate.live, gate.working, why)
    out.setdefault(closing.id, closing)
    _at_once(out, closing.id, {o.id for o in guarded})
    for k in first:
        out[k] = replace(out[k], after=(*out[k].after, closing.id))


def _at_once(out: dict[str, Operation], one: str, guarded: Set[str]) -> None:
    """Let an operation, and what it waits for, wait for none of the guarded: not for a hand to be emptied, either."""
    out[one] = replace(out[one], after=tuple(e for e in out[one].after if e not in guarded))
    for e in out[one].after:
        _at_once(out, e, guarded)


def _setting(out: Mapping[str, Operation], gate: Gate, value: Value) -> Operation | None:
    """Return the operation that sets a gate to a value; None where none does."""
    mine = (o for o in out.values() if sets(o, gate.component, gate.tunable) and o.arguments["to"] == value)
    return next(mine, None)


def _set_back(out: dict[str, Operation], gate: Gate, last: Sequence[str], was: str) -> None:
    """Let the gate be set as wanted after the last of the guarded operations."""
    if gate.goal is None or gate.goal == gate.working:
        return
    own = _setting(out, gate, gate.goal)
    back = replace(own, arguments={**own.arguments, "from": gate.working}) if own else None
    back = back or set_gate(gate, gate.working, gate.goal, was)
    out[back.id] = replace(back, after=(*back.after, *last))
