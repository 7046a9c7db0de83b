"""`pico apply`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import (
    Align,
    Exact,
    Exclude,
    Fidelity,
    LockTimeout,
    NoAlign,
    PlanOrRevision,
    Prefer,
    Scoped,
    StopOnError,
    Yes,
    aligning,
    scope_of,
)
from ..runs.approving import approve
from ..session import Session

HEADING = "The main job"
ORDER = 40

CLASS = Scoped
Record = Annotated[
    Path | None,
    typer.Option("--record", metavar="FILE", help="Film it: FILE.mp4 or FILE.gif."),
]

Detach = Annotated[bool, typer.Option("--detach", help="Leave it to the bench, and give the prompt back.")]
Refresh = Annotated[bool, typer.Option("--refresh", help="Plan to the goal of a saved plan anew.")]


def apply(
    context: typer.Context,
    what: PlanOrRevision = None,
    auto_approve: Yes = False,
    align: Align = False,
    no_align: NoAlign = False,
    exact: Exact = False,
    fidelity: Fidelity = None,
    exclude: Exclude = None,
    prefer: Prefer = "fewest-moves",
    record: Record = None,
    stop_on_error: StopOnError = False,
    refresh: Refresh = False,
    detach: Detach = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Show the plan, ask, and move what it says.

    Without an argument the bench becomes equal to the manifest. With names after `--` only these components or single
    tunables do, and the manifest stays as it is. With --align goals of the lab that are not aligned then are sought at
    the end; the exit code is 6 where one is not met. A saved plan is refused (exit code 4) where what it stands on has
    changed since. `pico runs attach` follows what is left to the bench. With --json: the plan, each event and the
    report, a line each.

    Examples:
      pico apply e1
      pico apply e1 -- p2 p1.angle
      pico apply e1 --align
      pico apply ./e1.plan --yes --record e1.mp4
    """
    session = Session.of(context)
    if record:
        from pico.drawing.film.movie_file import require_kind

        require_kind(session.folder / record)
    bench = session.bench(fidelity, writing=True)
    options = {
        "align": aligning(align, no_align),
        "exact": exact,
        "prefer": prefer,
        "targets": scope_of(context),
        "exclude": exclude or (),
    }
    plan = bench.plans.plan_of(what, folder=session.folder, **options)
    if what is not None and not isinstance(bench.history.find(what, session.folder), str):
        if refresh:
            plan = bench.plans.refreshed(plan)
        else:
            bench.plans.require_permitted(plan)
    elif refresh:
        raise PicoError(error("usage", "--refresh is for a saved plan", hint="without one every plan is a new one"))
    if detach and record:
        raise PicoError(
            error("usage", "a run that is left to the bench is not filmed", hint="leave out one of the two")
        )
    code = approve(session, bench, plan, auto_approve, record, detach=detach, stop_on_error=stop_on_error)
    if not code and bench.plans.leaves_manifest(plan):
        where = plan.target.revision
        back = "`pico apply` returns the bench to it"
        session.say(f"The manifest still describes another state: {back}, `pico checkout {where}` switches the files.")
    return code
