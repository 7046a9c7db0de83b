"""What safety inputs allow: before an arm moves or light is let out, and for as long as that goes on."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from dataclasses import replace

from pico.backends.attempt import Failed
from pico.backends.hardware.guard.hearing import unsafe
from pico.backends.hardware.guard.verdict import LIGHT, MOTION
from pico.backends.hardware.instruments import Instruments
from pico.diagnostics import Diagnostic, PicoError, error
from pico.drivers.protocols import SafetyInput, SafetyState
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.model.wiring import SafetyEntry, SafetyKind
from pico.planning.checks.emission import lets_out

EVERY = 0.1
"""How often they are asked while something goes on [s]."""
Inputs = Mapping[str, tuple[SafetyEntry, SafetyInput]]


def concerned(setup: Setup, operation: Operation) -> frozenset[SafetyKind]:
    """Return the kinds of safety inputs that must be safe for an operation."""
    moves = MOTION if operation.robot is not None or operation.kind.parks else frozenset[SafetyKind]()
    return moves | (LIGHT if lets_out(setup, operation) else frozenset[SafetyKind]())


def require_known_arms(setup: Setup, bench: Instruments, operation: Operation) -> None:
    """Raise Failed for a motion of any arm, and for light that is let out, if an arm can't be had: nobody knows where
    it stands then, and what it holds."""
    moves = operation.robot is not None or operation.kind.parks
    if not bench.armless or not (moves or lets_out(setup, operation)):
        return
    robot, why = next(iter(sorted(bench.armless.items())))
    text = f"{why[0].summary}; without {robot} no arm moves, and no light is let out: its position is unknown"
    raise Failed(replace(why[0], severity="error", summary=text, address=operation.address))


async def tripped(inputs: Inputs, kinds: Iterable[SafetyKind]) -> Diagnostic | None:
    """Return why one of the inputs of these kinds is not safe; None where all are. What is unknown, or was heard too
    long ago, is unsafe."""
    asked = {name: pair for name, pair in inputs.items() if pair[0].kind in kinds}
    found = await asyncio.gather(*(one.read() for _, one in asked.values()), return_exceptions=True)
    for (name, (entry, _)), state in zip(asked.items(), found, strict=True):
        if why := _unsafe(entry, state):
            text = f"{name} ({entry.kind.replace('_', ' ')}) {why}"
            return error("unsafe", text, hint="look what it is, then begin anew", address=name)
    return None


def _unsafe(entry: SafetyEntry, state: SafetyState | BaseException) -> str:
    if isinstance(state, PicoError):
        return f"can't be read: {state.diagnostics[0].summary}"
    if isinstance(state, BaseException):
        raise state
    return unsafe(entry, state)


async def require_safe(inputs: Inputs, kinds: Iterable[SafetyKind]) -> None:
    """Raise Failed where an input of these kinds is not safe."""
    if (wrong := await tripped(inputs, kinds)) is not None:
        raise Failed(wrong)


async def until_tripped(inputs: Inputs, kinds: frozenset[SafetyKind]) -> Diagnostic:
    """Ask the inputs of these kinds again and again, and return why one is not safe any more."""
    while (wrong := await tripped(inputs, kinds)) is None:
        await asyncio.sleep(EVERY)
    return wrong
