"""`pico resume`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Fidelity, LockTimeout, Speed, StopOnError, Yes
from ..runs.approving import approve, going_back
from ..session import Session

HEADING = "The main job"
ORDER = 60


def resume(
    context: typer.Context,
    run: Annotated[
        str | None, typer.Argument(metavar="[RUN]", help="The last run, to be sure that it is meant.")
    ] = None,
    auto_approve: Yes = False,
    fidelity: Fidelity = None,
    speed: Speed = None,
    stop_on_error: StopOnError = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Take up the last run again, which was cut short, failed or killed.

    It plans anew, from what stands on the table now to the goal of that run: nothing that is done is done again. What
    a hand still holds is set down first. At the lab's speed: that of a run which was told another one is said again.

    Examples:
      pico resume
      pico resume --stop-on-error
    """
    session = Session.of(context)
    bench = going_back(session, "resume", auto_approve, fidelity, speed, run=run)
    plan, last = bench.recovery.resume_plan(run)
    return approve(session, bench, plan, auto_approve, resumes=last, stop_on_error=stop_on_error)
