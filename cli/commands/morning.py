"""One operation at a time, 8: `pico morning`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import DetailedExit, DryRun, Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import morning as view
from ..views import optimizing as live
from ..views import survey as ahead_view

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
    """Read the light of the bench, and say what befell it overnight.

    Arms stay parked. Powers, pointing and dark frames are read, and the nulls of polarizers by motors that go back to
    where they stood, also on Ctrl-C. What differs from the last morning that was accepted is told, with the part that
    explains it best and the shortest repair. The first morning is accepted; no laser is opened for it.

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
        survey = bench.mornings.survey()
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

    report, found = bench.mornings.read(survey, heard, say, accept=accept)
    if terminal:
        write(sys.stdout, "", end="", over=True)
    session.show(view, found)
    session.tell(report.diagnostics)
    if report.exit_code:
        return int(report.exit_code)
    if found.cut_short:
        return int(ExitCode.INTERRUPTED)
    return int(ExitCode.CHANGES if detailed_exitcode and found.unusual else ExitCode.DONE)
