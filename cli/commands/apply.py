"""`pico apply`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Exact, Exclude, Fidelity, PlanOrRevision, Prefer, Targets, Yes
from ..running import execute, question
from ..scope import scope_of
from ..session import Session
from ..views import plan as view
from ..views import verified
from ..views.report import expectations

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan

Record = Annotated[
    Path | None,
    typer.Option("--record", metavar="FILE", help="Film it in the simulator, in simulated time: FILE.mp4 or FILE.gif."),
]

StopOnError = Annotated[
    bool, typer.Option("--stop-on-error", help="Start nothing more once an operation fails, not even beside it.")
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
    plan = bench.plan_of(what, folder=session.folder, **options)
    if is_saved(bench, what, session.folder):
        if refresh:
            plan = bench.refreshed(plan)
        bench.require_fresh(plan)
    elif refresh:
        raise PicoError(error("usage", "--refresh is for a saved plan", hint="without one every plan is a new one"))
    return approve(session, bench, plan, auto_approve, record, stop_on_error=stop_on_error)


def is_saved(bench: Bench, what: str | None, folder: Path) -> bool:
    """Return whether a word means a saved plan."""
    return what is not None and not isinstance(bench.find(what, folder), str)


def _expected(session: Session, bench: Bench, plan: Plan) -> int:
    """Check the expectations of a goal that the bench has reached already."""
    if not plan.target.expect or plan.target.scope:
        return ExitCode.DONE
    found = bench.expected(plan)
    if session.json:
        session.document(verified.data(found))
    session.say("\n".join(expectations(found.expectations)))
    return found.exit_code


def approve(
    session: Session, bench: Bench, plan: Plan, auto_approve: bool, record: Path | None = None, **options: Any
) -> int:
    """Show a plan, ask, run it, and return the exit code; `options` are those of `AsyncBench.run`."""
    if plan.operations and not auto_approve and session.json:
        raise PicoError(error("usage", "with --json nobody is asked", hint="add --auto-approve"))
    session.show(view, plan, head=bench.head_name(), goal=bench.goal_name(plan))
    if not session.json:
        session.report(plan.diagnostics)
    if plan.errored:
        return ExitCode.IMPOSSIBLE
    if plan.denied:
        return ExitCode.DENIED
    if not plan.operations:
        bench.settle()
        return _expected(session, bench, plan) if plan.reached else ExitCode.ERROR
    session.say("")
    if not auto_approve and not session.confirm(question(plan)):
        session.say("Nothing moved.")
        return ExitCode.ERROR
    return execute(session, bench, plan, record, **options)
