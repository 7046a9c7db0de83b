"""The main job, 7: `pico undo`."""

from __future__ import annotations

import typer

from ..arguments import Fidelity, LockTimeout, Speed, Yes
from ..runs.approving import approve
from ..session import Session


def undo(
    context: typer.Context, auto_approve: Yes = False, fidelity: Fidelity = None, speed: Speed = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Take back what the last run moved or set.

    Files stay as they are. Undone twice, it is as the run left it. At the lab's speed, whatever the run was told.

    Examples:
      pico undo
    """
    session = Session.of(context)
    bench = session.bench(fidelity, speed, writing=True)
    return approve(session, bench, bench.recovery.undo_plan(), auto_approve)
