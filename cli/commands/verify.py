"""`pico verify`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import LockTimeout, Revision, Yes
from ..runs.approving import declined, show
from ..runs.running import ran
from ..session import Session
from ..views import verified as view

HEADING = "History"
ORDER = 80

Measure = Annotated[
    bool, typer.Option("--measure", help="Measure its goals, what its expectations speak of, and its recorded light.")
]


def verify(
    context: typer.Context,
    revision: Revision = None,
    measure: Measure = False,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Check that the bench is as wanted, and that expectations hold.

    As the manifest wants it, or a revision. Moves nothing without --measure. Says as well whether any bench ever stood
    as that commit (HEAD without one) says, by which run, and whether that was simulated; it exits the same either way.

    With --measure it takes the bench, parks its arms and measures: each goal once, where its tunables stand, then what
    expectations speak of and the light that the commit recorded. Nothing is sought, and all is set back. Without, what
    speaks of a measurable is not assured. Exits with 6 where an expectation fails or can't be told, a goal is lost or
    the light differs; with 1 where something stands elsewhere than it should.

    Examples:
      pico verify
      pico verify e1 --measure
    """
    from pico.bench.in_use import goes_on

    session = Session.of(context)
    bench = session.bench(writing=measure)
    asked, report = bench.measurements.to_verify(revision) if measure else None, None
    if asked and asked.plan.operations:
        code = show(session, bench, asked.plan, auto_approve, goal="measurements")
        if code := code or declined(session, bench, asked.plan, auto_approve):
            return code
        report = ran(session, bench, asked.plan)
        if report.exit_code:
            return report.exit_code
    found = bench.measurements.verify(revision, asked.told if asked else (), report)
    session.tell(goes_on(bench))
    session.show(view, found, suspects=bench.light.suspected(found.light or (), found.changes))
    if found.standing and not session.json:
        session.report(found.standing.diagnostics)
    return found.exit_code
