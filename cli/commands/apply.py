"""The main job, 4: `pico apply`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import (
    Exact,
    Exclude,
    Fidelity,
    LockTimeout,
    PlanOrRevision,
    Prefer,
    Scoped,
    StopOnError,
    Targets,
    Yes,
    scope_of,
)
from ..runs.approving import approve
from ..session import Session

CLASS = Scoped
Record = Annotated[
    Path | None,
    typer.Option("--record", metavar="FILE", help="Film it in the simulator, in simulated time: FILE.mp4 or FILE.gif."),
]

Refresh = Annotated[
    bool, typer.Option("--refresh", help="Plan anew to the goal of the saved plan, from what stands there now.")
]


def apply(
    context: typer.Context,
    what: PlanOrRevision = None,
    auto_approve: Yes = False,
    exact: Exact = False,
    fidelity: Fidelity = None,
    target: Targets = None,
    exclude: Exclude = None,
    prefer: Prefer = "fewest-moves",
    record: Record = None,
    stop_on_error: StopOnError = False,
    refresh: Refresh = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Move what the plan says.

    Without an argument the bench becomes equal to the manifest. With names after `--` only these components or single
    tunables do, and the manifest stays as it is: `pico apply e1 -- p2 p1.angle`. A name that is both a file and a
    revision is an error; ./NAME is the file. A saved plan is refused (exit code 4) where what it stands on has changed
    since. With --json: the plan, each event and the report, a line each.
    """
    session = Session.of(context)
    if record:
        from pico.drawing.film.movie_file import require_kind

        require_kind(session.folder / record)
    bench = session.bench(fidelity, writing=True)
    targets = (*(target or ()), *scope_of(context))
    options = {"exact": exact, "prefer": prefer, "targets": targets, "exclude": exclude or ()}
    plan = bench.plans.plan_of(what, folder=session.folder, **options)
    if what is not None and not isinstance(bench.history.find(what, session.folder), str):
        if refresh:
            plan = bench.plans.refreshed(plan)
        bench.plans.require_fresh(plan)
    elif refresh:
        raise PicoError(error("usage", "--refresh is for a saved plan", hint="without one every plan is a new one"))
    return approve(session, bench, plan, auto_approve, record, stop_on_error=stop_on_error)
