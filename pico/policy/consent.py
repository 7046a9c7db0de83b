"""Which operations somebody is asked about before they run: one rule, whichever command they come from."""

from __future__ import annotations

from collections.abc import Sequence

from pico.model.operation import Operation
from pico.model.setup import Setup

_DARK = ("closed", False, 0)


def asked_about(setup: Setup, operations: Sequence[Operation]) -> bool:
    """Return whether any operation moves something (an arm, a motor, a person's hand, a primitive that nobody knows) or
    lets light out. What electronics alone keep, as an exposure, is not asked about; nor is a shutter that closes."""
    return any(_moves(setup, op) for op in operations) or bool(lights(setup, operations))


def lights(setup: Setup, operations: Sequence[Operation]) -> tuple[str, ...]:
    """Return the tunables that let light out, as `laser.shutter`: those of sources and shutters, unless they close, or
    let it out already before the first operation, and are only closed in between."""
    first: dict[str, Operation] = {}
    for op in operations:
        if _of_light(setup, op):
            first.setdefault(op.address, op)
    opened = {op.address for op in operations if op.address in first and op.arguments.get("to") not in _DARK}
    return tuple(name for name, op in first.items() if name in opened and op.arguments.get("from") in (None, *_DARK))


def _moves(setup: Setup, op: Operation) -> bool:
    if not op.kind.mutating:
        return False
    return not (op.primitive in ("set", "auto_range") and _mover(setup, op) == "electronics")


def _of_light(setup: Setup, op: Operation) -> bool:
    if op.primitive != "set" or _mover(setup, op) != "electronics":
        return False
    element = setup.type_of(op.component).optics.element
    return element in ("source", "shutter") or op.arguments.get("tunable") in ("shutter", "emission")


def _mover(setup: Setup, op: Operation) -> str:
    """Return what drives the tunable that an operation sets; empty where the bench has no such tunable."""
    known = op.component in setup.lab.inventory
    kind = setup.type_of(op.component).tunables.get(str(op.arguments.get("tunable"))) if known else None
    return kind.mover if kind else ""
