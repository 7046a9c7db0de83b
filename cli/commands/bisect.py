"""`pico bisect`: which configuration broke an expectation."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.bench.bisecting import begin, under_way
from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Fidelity, LockTimeout, Yes, group
from ..runs.approving import declined, question
from ..runs.trying import bring, go_on
from ..session import Session
from ..terminal.output import write
from ..views import bisect as view

HEADING = "History"
ORDER = 70

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.history.bisect.git_state import Verdict
    from pico.model.plan import Plan

Bad = Annotated[str, typer.Argument(metavar="BAD", help="A revision that is bad.")]
Good = Annotated[str, typer.Argument(metavar="GOOD", help="An earlier one that is good.")]
Commit = Annotated[str | None, typer.Argument(metavar="REV", help="Another one than that under trial.")]
Expect = Annotated[
    str | None,
    typer.Option("--expect", metavar="CEL", help="What must hold of the bench: 'p2.pose.x < 530'."),
]
Measure = Annotated[
    float,
    typer.Option("--measure-seconds", metavar="S", help="How long a measurement takes: weighed against motion.", min=0),
]
Trust = Annotated[bool, typer.Option("--trust", help="Do not measure the good and the bad end first.")]
Suspicion = Annotated[
    float,
    typer.Option(
        "--suspicion",
        metavar="TIMES",
        help="How many times likelier a commit is that changed a part that the expression speaks of; 1: all are alike.",
        min=1,
    ),
]

Wanted = Annotated[str, typer.Option("--expect", metavar="CEL", help="What must hold: 'p2.pose.x < 530'.")]
CODES = {"good": 0, "bad": 1, "skip": 125}

app = group(
    help="Find by trials which configuration broke an expectation.",
    examples=("pico bisect run e2 C1 --expect 'p2.pose.yaw < 20.0'", "pico bisect start main v3", "pico bisect good"),
    alone=True,
)


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        status(context)


@app.command()
def start(
    context: typer.Context, bad: Bad, good: Good, expect: Expect = None, measure_seconds: Measure = 5.0,
    trust: Trust = False, suspicion: Suspicion = 10.0, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Begin: bring the bench to the first configuration.

    With --expect it is judged, and so on; else you judge it. Nothing is checked out: files and edits stay as they are.
    What is tried next is chosen by what it costs the bench to get there, and git keeps the log: `git bisect log`,
    `visualize`, `replay` and `reset` work.

    Examples:
      pico bisect start main v3
    """
    how = {"expect": expect, "measure": measure_seconds, "trust": trust, "suspicion": suspicion}
    return _begin(context, bad, good, how, auto_approve, fidelity)


@app.command()
def run(
    context: typer.Context, bad: Bad, good: Good, expect: Expect = None, measure_seconds: Measure = 5.0,
    trust: Trust = False, suspicion: Suspicion = 10.0, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Find the first bad commit, by --expect or the bad one's `expect:`.

    Both ends are measured first: if the good one is not good now, the cause is not in the history. A configuration
    that can't be built, or of which the bench can't tell, is skipped. The same command goes on where it was
    interrupted.

    Examples:
      pico bisect run e2 C1 --expect 'p2.pose.yaw < 20.0'
    """
    how = {"expect": expect, "measure": measure_seconds, "trust": trust, "suspicion": suspicion, "from_bad": True}
    return _begin(context, bad, good, how, auto_approve, fidelity)


@app.command(name="continue")
def continue_(
    context: typer.Context, expect: Expect = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Go on with the bisection under way, from the bench as it stands.

    Examples:
      pico bisect continue
    """
    session = _approving(context, auto_approve)
    bench = session.bench(fidelity, writing=True)
    return go_on(session, bench, under_way(bench, expect=expect), auto_approve)


@app.command()
def good(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """The configuration under trial is good; go on to the next.

    Examples:
      pico bisect good
    """
    return _told(context, "good", commit, auto_approve, fidelity)


@app.command()
def bad(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """The configuration under trial is bad; go on to the next.

    Examples:
      pico bisect bad
    """
    return _told(context, "bad", commit, auto_approve, fidelity)


@app.command()
def skip(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Nobody can tell of the one under trial; go on to another.

    Examples:
      pico bisect skip
    """
    return _told(context, "skip", commit, auto_approve, fidelity)


@app.command()
def status(context: typer.Context) -> None:
    """Show what was tried, what is under trial, and how many are left.

    Examples:
      pico bisect status
    """
    session = Session.of(context)
    bench = session.bench()
    search = under_way(bench)
    session.show(view.StandingView, search, search.outcome(), bench.history.name_of)


@app.command()
def log(context: typer.Context) -> None:
    """Print git's log of the bisection, for `git bisect replay`.

    Examples:
      pico bisect log > search.log
    """
    session = Session.of(context)
    text = under_way(session.bench()).git.log()
    if session.json:
        session.document({"schema": "pico.bisect/v1", "kind": "log", "log": text})
    else:
        write(sys.stdout, text, end="")


@app.command()
def reset(context: typer.Context) -> None:
    """End the bisection. Files and bench stay as they are.

    Examples:
      pico bisect reset
    """
    session = Session.of(context)
    under_way(session.bench()).git.reset()
    if session.json:
        session.document({"schema": "pico.bisect/v1", "kind": "reset"})
    session.say("The bisection is over. The bench stays where it is; `pico apply` brings it to the manifest.")


@app.command()
def step(
    context: typer.Context, expect: Wanted, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """One trial, for `git bisect run`: bring the bench there, judge it.

    To the commit that git bisects, best after `git bisect start --no-checkout`. Exits with 0 where it is good, 1 where
    it is bad, 125 where it can't be built or told, and from 128 on where the bench is in trouble, so that git stops:
    128 more than the exit code of `pico apply`.

    Examples:
      git bisect run pico bisect step -y --expect 'p2.pose.x < 530'
    """
    from pico.bench.bisecting import step as trial

    session = Session.of(context)
    try:
        bench = session.bench(fidelity, writing=True)
    except PicoError as exc:
        if not trial.bisecting(session.folder):
            raise
        found = trial.TrialStep(commit="HEAD", verdict="skip", why=f"can't be read: {exc.diagnostics[0].summary}")
    else:
        found = trial.step(bench, expect, lambda plan: _seconds(session, bench, plan, auto_approve))
    session.show(view.StepView, found)
    return CODES[found.verdict]


def _begin(
    context: typer.Context, bad: str, good: str, how: dict[str, Any], auto_approve: bool, fidelity: str | None
) -> int:  # fmt: skip
    session = _approving(context, auto_approve)
    bench = session.bench(fidelity, writing=True)
    search = begin(bench, bad, good, **how)
    session.show(view.Begun, search)
    return go_on(session, bench, search, auto_approve)


def _told(
    context: typer.Context, verdict: Verdict, commit: str | None, auto_approve: bool, fidelity: str | None
) -> int:  # fmt: skip
    session = _approving(context, auto_approve)
    bench = session.bench(fidelity, writing=True)
    search = under_way(bench)
    tried = search.told(verdict, bench.folder.history().resolve(commit).id if commit else None)
    session.show(view.TriedView, search, tried)
    return go_on(session, bench, search, auto_approve)


def _approving(context: typer.Context, auto_approve: bool) -> Session:
    session = Session.of(context)
    session.require_answer(auto_approve)
    return session


def _seconds(session: Session, bench: Bench, plan: Plan, auto_approve: bool) -> float:
    """Run a plan, and return how long the bench took [s]; raises PicoError where it did not get there."""
    session.require_answer(auto_approve or not question(bench.setup, plan))
    if declined(session, bench, plan, auto_approve):
        raise PicoError(error("declined", "the trial was declined", hint="`git bisect run` again goes on"))
    seconds, code = bring(session, bench, plan)
    if code:
        text = f"the bench did not get to {bench.history.goal_name(plan)}"
        hint = "`pico status` shows how it stands; `git bisect run` again goes on"
        raise PicoError(error("not-there", text, hint=hint), ExitCode(code))
    return seconds
