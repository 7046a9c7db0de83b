"""The main job, 7: `pico undo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, OfPerson, RunBack, Speed, Yes
from ..runs.approving import approve, called
from ..session import Session


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
    bench = session.bench(fidelity, speed, writing=True)
    if auto_approve and run is None:
        bench.recovery.require_named("undo", of)
    session.tell(bench.recovery.killed_early())
    called(session, bench, "undo", auto_approve)
    return approve(session, bench, bench.recovery.undo_plan(run, of=of), auto_approve)
