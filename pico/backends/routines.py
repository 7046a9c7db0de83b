"""What a plug-in's primitive asks an arm to do with a tool, on the bench as it is now. For every backend."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.diagnostics import PicoError
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.planning.routines import Routine, routine_of


def asked_of(setup: Setup, seen: Observation, operation: Operation) -> Routine | None:
    """Return what an operation asks an arm to do, as `pico.planning.routines.routine_of`; raises Failed."""
    try:
        return routine_of(setup, seen, operation)
    except PicoError as exc:
        raise Failed(exc.diagnostics[0]) from exc
