"""`pico undo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, OfPerson, RunBack, Speed, Yes
from ..runs.approving import approve, going_back
from ..session import Session

HEADING = "The main job"
ORDER = 70


def undo(
    context: typer.Context, run: RunBack = None, of: OfPerson = None, auto_approve: Yes = False,
    fidelity: Fidelity = None, speed: Speed = None, lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Take back what the last run changed on the bench.

    Runs that set something to measure and set it back are skipped. A run that is named must still be in place. Light
    stays off, and files as they are. Undone twice, it is as the run left it, as with `pico redo`.

    Examples:
      pico undo
      pico undo 8cd36b
    """
    session = Session.of(context)
    bench = going_back(session, "undo", auto_approve, fidelity, speed, run=run, of=of)
    return approve(session, bench, bench.recovery.undo_plan(run, of=of), auto_approve)
