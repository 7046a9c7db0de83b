"""Faults of devices, cleared after a person at the terminal confirmed what they ask to check."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from pico.diagnostics import ExitCode, PicoError, error
from pico.model.instruments.fault import AGAIN, DeviceFault

from ..session import Session
from ..views import fault as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench


def clear_faults(session: Session, bench: Bench) -> ExitCode:
    """Name each fault of the bench's devices, ask the person at the terminal to check it, and clear it; return DONE, or
    ERROR if one was not confirmed.

    No option answers these questions. Raises PicoError if nobody is at a terminal of the bench's own computer, and for
    a fault that is still there.
    """
    while faults := bench.recovery.faults():  # asked again: one may have hidden another
        fault = faults[0]
        require_person(session, bench, fault)
        session.say(view.text(fault))
        if not session.confirm(view.QUESTION, False, by_person=True):
            session.say(f"Nothing was cleared. Check it, then {AGAIN}.")
            return ExitCode.ERROR
        bench.recovery.clear_fault(fault)
        session.say(view.cleared(fault))
    return ExitCode.DONE


def require_person(session: Session, bench: Bench, fault: DeviceFault) -> None:
    """Raise PicoError unless a person can be asked about a fault here."""
    if session.json or bench.far is not None or sys.stdin is None or not sys.stdin.isatty():
        where = "there is no terminal here"
        if bench.far is not None:
            where = "`pico gui` serves the bench: close it" if bench.far.local else f"{bench.far.said} is elsewhere"
        hint = f"{fault.check}; then a person calls `pico recover` at a terminal of the bench's own computer"
        detail = f"a person must confirm that, and {where}; no option and no program confirms it"
        raise PicoError(error(fault.code, str(fault), detail=detail, hint=hint, address=fault.device))
