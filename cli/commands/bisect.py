"""History, 7: `pico bisect`: which configuration broke an expectation."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.bench.bisecting import begin, under_way

from ..arguments import Fidelity, LockTimeout, Yes
from ..runs.trying import go_on
from ..session import Session
from ..terminal.output import write
from ..views import bisect as view

if TYPE_CHECKING:
    from pico.history.bisect.git_state import Verdict

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

app = typer.Typer(
    rich_markup_mode=None,
    help="Find which configuration broke an expectation, by trials on the bench.",
)


@app.callback(invoke_without_command=True)
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        status(context)


@app.command()
def start(
    context: typer.Context, bad: Bad, good: Good, expect: Expect = None, measure_seconds: Measure = 5.0,
    trust: Trust = False, suspicion: Suspicion = 10.0, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Begin: bring the bench to the first configuration. With --expect it is judged, and so on; else you judge it.

    Nothing is checked out: files and edits stay as they are. What is tried next is chosen by what it costs the bench
    to get there, and git keeps the log: `git bisect log`, `visualize`, `replay` and `reset` work.
    """
    how = {"expect": expect, "measure": measure_seconds, "trust": trust, "suspicion": suspicion}
    return _begin(context, bad, good, how, auto_approve, fidelity)


@app.command()
def run(
    context: typer.Context, bad: Bad, good: Good, expect: Expect = None, measure_seconds: Measure = 5.0,
    trust: Trust = False, suspicion: Suspicion = 10.0, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Find the first bad commit, by what --expect says, else by the `expect:` of the bad one.

    Both ends are measured first: if the good one is not good now, the cause is not in the history. A configuration that
    can't be built, or of which the bench can't tell, is skipped. The same command goes on where it was interrupted.
    """
    how = {"expect": expect, "measure": measure_seconds, "trust": trust, "suspicion": suspicion, "from_bad": True}
    return _begin(context, bad, good, how, auto_approve, fidelity)


@app.command(name="continue")
def continue_(
    context: typer.Context, expect: Expect = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Go on with the bisection under way, from the bench as it stands."""
    session = _approving(context, auto_approve)
    bench = session.bench(fidelity, writing=True)
    return go_on(session, bench, under_way(bench, expect=expect), auto_approve)


@app.command()
def good(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """The configuration under trial is good; go on to the next."""
    return _told(context, "good", commit, auto_approve, fidelity)


@app.command()
def bad(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """The configuration under trial is bad; go on to the next."""
    return _told(context, "bad", commit, auto_approve, fidelity)


@app.command()
def skip(
    context: typer.Context, commit: Commit = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Nobody can tell whether the configuration under trial is good; go on to another."""
    return _told(context, "skip", commit, auto_approve, fidelity)


@app.command()
def status(context: typer.Context) -> None:
    """Show what was tried, what is under trial, and how many are left."""
    session = Session.of(context)
    bench = session.bench()
    search = under_way(bench)
    session.show(view.StandingView, search, search.outcome(), bench.history.name_of)


@app.command()
def log(context: typer.Context) -> None:
    """Print git's log of the bisection, for `git bisect replay`."""
    session = Session.of(context)
    text = under_way(session.bench()).git.log()
    if session.json:
        session.document({"schema": "pico.bisect/v1", "kind": "log", "log": text})
    else:
        write(sys.stdout, text, end="")


@app.command()
def reset(context: typer.Context) -> None:
    """End the bisection. Files and bench stay as they are."""
    session = Session.of(context)
    under_way(session.bench()).git.reset()
    if session.json:
        session.document({"schema": "pico.bisect/v1", "kind": "reset"})
    session.say("The bisection is over. The bench stays where it is; `pico apply` brings it to the manifest.")


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
