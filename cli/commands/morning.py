"""`pico morning`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import DetailedExit, DryRun, Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import morning as view
from ..views import optimizing as live
from ..views import survey as ahead_view

HEADING = "One operation at a time"
ORDER = 80

if TYPE_CHECKING:
    from pico.model.trace.event import Event


def morning(
    context: typer.Context,
    accept: Annotated[bool, typer.Option("--accept", help="This morning is the reference from now on.")] = False,
    detailed_exitcode: DetailedExit = False,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Measure the light of the bench and report what changed overnight.

    Arms stay parked. Powers, pointing and dark frames are read, and the nulls of polarizers by motors that go back to
    where they stood, also on Ctrl-C; no laser is opened. What differs from the last morning that was accepted is listed
    with what happened: parts that were moved, and the parts that explain the rest best, each with its repair. Only
    --accept makes a morning the reference.

    Examples:
      pico morning
      pico morning --dry-run
      pico morning --accept
    """
    from pico.diagnostics import ExitCode

    from ..runs.approving import declined, show
    from ..runs.running import say
    from ..terminal.output import write
    from ..terminal.waiting import waiting

    session = Session.of(context)
    bench = session.bench(fidelity, None, writing=not dry_run)
    with waiting("Looking where the light goes"):
        survey = bench.mornings.survey(accept=accept)
    if survey.plan.errored or not session.json:
        code = show(session, bench, survey.plan, auto_approve or dry_run, single=True)
        if code:
            return int(code)
    if dry_run:
        session.show(ahead_view, survey)
        return 0
    if code := declined(session, bench, survey.plan, auto_approve):
        return int(code)
    terminal = sys.stdout.isatty() and not session.json

    def heard(event: Event) -> None:
        if session.json:
            session.document(live.data(event))
        elif terminal and (line := view.line(event)):
            write(sys.stdout, line, end="", over=True)

    report, found = bench.mornings.read(survey, heard, say)
    if terminal:
        write(sys.stdout, "", end="", over=True)
    session.show(view, found)
    session.tell(report.diagnostics)
    if report.exit_code:
        return int(report.exit_code)
    if found.cut_short:
        return int(ExitCode.INTERRUPTED)
    return int(ExitCode.CHANGES if detailed_exitcode and found.unusual else ExitCode.DONE)
