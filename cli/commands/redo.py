"""`pico redo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, OfPerson, RunBack, Speed, Yes
from ..runs.approving import approve, going_back
from ..session import Session

HEADING = "The main job"
ORDER = 80


def redo(
    context: typer.Context, run: RunBack = None, of: OfPerson = None, auto_approve: Yes = False,
    fidelity: Fidelity = None, speed: Speed = None, lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Take an undo back.

    The last run, if it is an undo; or the one that is named, by its id or by that of the run that it took back. What it
    left must still be in place.

    Examples:
      pico redo
      pico redo 8cd36b
    """
    session = Session.of(context)
    bench = going_back(session, "redo", auto_approve, fidelity, speed, run=run, of=of)
    return approve(session, bench, bench.recovery.redo_plan(run, of=of), auto_approve)
