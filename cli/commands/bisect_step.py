"""History, 8: `pico bisect-step`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Fidelity, LockTimeout, Yes
from ..runs.approving import declined, question
from ..runs.trying import bring
from ..session import Session
from ..views import bisect as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan

CODES = {"good": 0, "bad": 1, "skip": 125}
Expect = Annotated[str, typer.Option("--expect", metavar="CEL", help="What must hold of the bench: 'p2.pose.x < 530'.")]


def bisect_step(
    context: typer.Context, expect: Expect, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Bring the bench to the commit that git bisects and judge it, for `git bisect run`.

    `git bisect run pico bisect-step -y --expect 'p2.pose.x < 530'`, best after `git bisect start --no-checkout`.
    Exits with 0 where it is good, 1 where it is bad, 125 where it can't be built or told, and from 128 on where
    the bench is in trouble, so that git stops: 128 more than the exit code of `pico apply`.
    """
    from pico.bench.bisecting.step import TrialStep, bisecting, step

    session = Session.of(context)
    try:
        bench = session.bench(fidelity, writing=True)
    except PicoError as exc:
        if not bisecting(session.folder):
            raise
        found = TrialStep(commit="HEAD", verdict="skip", why=f"can't be read: {exc.diagnostics[0].summary}")
    else:
        found = step(bench, expect, lambda plan: _seconds(session, bench, plan, auto_approve))
    session.show(view.StepView, found)
    return CODES[found.verdict]


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
