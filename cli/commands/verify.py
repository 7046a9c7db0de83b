"""History, 9: `pico verify`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import LockTimeout, Revision, Yes
from ..runs.approving import declined, show
from ..runs.running import ran
from ..session import Session
from ..views import verified as view

if TYPE_CHECKING:
    from pico.model.measurement import Measurement


Measure = Annotated[bool, typer.Option("--measure", help="Measure first what the expectations speak of.")]


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

    With --measure it takes the bench, parks its arms and measures, as `pico do COMPONENT measure` does; without, what
    speaks of a measurable is not assured. Exits with 6 where an expectation fails or can't be told, with 1 where
    something stands elsewhere than it should.

    Examples:
      pico verify
      pico verify e1 --measure
    """
    from pico.bench.in_use import goes_on

    session = Session.of(context)
    bench = session.bench(writing=measure)
    taken: Mapping[str, Measurement] = {}
    plan = bench.plans.to_measure(revision) if measure else None
    if plan and plan.operations:
        code = show(session, bench, plan, auto_approve, goal="measurements")
        if code := code or declined(session, bench, plan, auto_approve):
            return code
        report = ran(session, bench, plan)
        if report.exit_code:
            return report.exit_code
        taken = report.measurements
    found = bench.measurements.verify(revision, taken)
    session.tell(goes_on(bench))
    session.show(view, found)
    if found.standing and not session.json:
        session.report(found.standing.diagnostics)
    return found.exit_code
