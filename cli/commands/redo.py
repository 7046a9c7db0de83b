"""The main job, 7 again: `pico redo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, OfPerson, RunBack, Speed, Yes
from ..runs.approving import approve, called
from ..session import Session


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
    bench = session.bench(fidelity, speed, writing=True)
    if auto_approve and run is None:
        bench.recovery.require_named("redo", of)
    session.tell(bench.recovery.killed_early())
    called(session, bench, "redo", auto_approve)
    return approve(session, bench, bench.recovery.redo_plan(run, of=of), auto_approve)
