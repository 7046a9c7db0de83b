"""Takes a bisection on: brings the bench to one configuration after the other, until the first bad one is known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error

from ..session import Session
from ..terminal.waiting import waiting
from ..views import bisect as view
from ..views.run import Progress
from .approving import declined
from .running import Screen, watched

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.bisecting import Bisection, Proposal
    from pico.model.plan import Plan
    from pico.model.trace.event import Event

AGAIN = "`pico bisect continue` goes on: what was judged is in git's log"


def go_on(session: Session, bench: Bench, search: Bisection, auto_approve: bool) -> int:
    """Try configurations until the first bad one is known, or until a person has to judge; return the exit code."""
    shown = len(search.tried)
    try:
        while True:
            try:
                with waiting("Choosing what to try next"):
                    proposal = search.propose()
            finally:
                for tried in search.tried[shown:]:
                    session.show(view.TriedView, search, tried)
                shown = len(search.tried)
            if proposal is None:
                return _over(session, bench, search)
            code = _try(session, bench, search, proposal, auto_approve)
            if code is not None:
                return code
            shown = len(search.tried)
    except PicoError as exc:
        if exc.exit_code != ExitCode.LOCKED and search.git.under_way(search.git.root) is None:
            raise
        raise PicoError([*exc.diagnostics, Diagnostic("note", "bisect", AGAIN)], exc.exit_code) from exc
    except KeyboardInterrupt:
        raise PicoError(error("interrupted", "interrupted", hint=AGAIN), ExitCode.INTERRUPTED) from None


def _try(session: Session, bench: Bench, search: Bisection, proposal: Proposal, auto_approve: bool) -> int | None:
    """Bring the bench to a configuration and have it judged; return an exit code where that is the end of it."""
    name = bench.history.name_of(proposal.commit)
    if not search.task.expect or (proposal.plan.operations and not auto_approve):
        session.show(view.Proposed, search, proposal, name)
    said = f"Nothing moved. {AGAIN}; `pico bisect skip` leaves this one out."
    if no := declined(session, bench, proposal.plan, auto_approve, said):
        return no
    seconds, code = bring(session, bench, proposal.plan)
    if code:
        search.spent(proposal.commit, seconds, built=False)
        session.say(f"{AGAIN}.")
        return code
    if not search.task.expect:
        search.spent(proposal.commit, seconds, built=True)
        session.say(view.judge_it(name))
        return ExitCode.DONE
    tried = search.judge(proposal, seconds)
    session.show(view.TriedView, search, tried, proposal)
    return None


def bring(session: Session, bench: Bench, plan: Plan) -> tuple[float, int]:
    """Run the plan of a configuration; return how long the bench took [s], and 0 where it stands as planned."""
    if not plan.operations:
        bench.recovery.settle()
        return 0.0, ExitCode.DONE
    run = bench.run(plan.because("bisect"), holder=session.command)
    screen = Quiet(session, Progress(plan))
    watched(run, screen.show)
    screen.clear()
    report = run.report
    if report.outcome == "done" and report.reached:
        return report.seconds, ExitCode.DONE
    from ..views import report as report_view

    session.show(report_view, report)
    session.tell(report.diagnostics)
    return report.seconds, ExitCode.INTERRUPTED if report.outcome == "interrupted" else ExitCode.ERROR


class Quiet(Screen):
    """On a terminal the line that is overwritten; else nothing: a configuration is one line."""

    def show(self, event: Event) -> None:
        if not self.session.json and not self.progress.line(event):
            super().show(event)


def _over(session: Session, bench: Bench, search: Bisection) -> int:
    outcome = search.outcome()
    entry = bench.history.entry(outcome.first_bad) if outcome.first_bad else None
    session.show(view.EndView, search, outcome, entry, bench.history.name_of)
    return ExitCode.DONE if outcome.first_bad else ExitCode.ERROR
