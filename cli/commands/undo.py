"""The main job, 7: `pico undo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, Yes
from ..runs.approving import approve
from ..session import Session


def undo(
    context: typer.Context, auto_approve: Yes = False, fidelity: Fidelity = None, lock_timeout: LockTimeout = None
) -> int:
    """Take back what the last run moved or set.

    Files stay as they are. Undone twice, it is as the run left it.

    Examples:
      pico undo
    """
    session = Session.of(context)
    bench = session.bench(fidelity, writing=True)
    return approve(session, bench, bench.recovery.undo_plan(), auto_approve)
