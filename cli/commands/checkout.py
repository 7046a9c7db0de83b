"""`pico checkout`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..arguments import Fidelity, Yes
from ..running import execute, question
from ..session import Session
from ..views import plan as view


def checkout(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="A branch, tag or commit.")],
    auto_approve: Yes = False,
    fidelity: Fidelity = None,
) -> int:
    """Go to a revision: files and bench.

    Plans from the revision's own files, asks, runs `git checkout`, then moves the bench. Refused where the manifest
    holds changes that are not committed. If a move fails, the files stay at REV and `pico status` tells the truth.
    """
    session = Session.of(context)
    bench = session.bench(fidelity)
    plan = bench.checkout_plan(revision)
    session.show(view, plan, head=bench.head_name(), goal=bench.goal_name(plan))
    if not session.json:
        session.report(plan.diagnostics)
    if plan.errored:
        return ExitCode.IMPOSSIBLE
    if plan.denied:
        return ExitCode.DENIED
    if plan.operations and not auto_approve and (session.json or not session.confirm("\n" + question(plan))):
        session.say("Nothing moved; the files are where they were.")
        return ExitCode.ERROR
    notes = bench.checkout_files(revision)
    if not session.json:
        session.report(notes)
    session.say(f"\nThe files are at {bench.head_name()}.")
    return execute(session, bench, plan) if plan.operations else ExitCode.DONE
