"""`pico recover`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..arguments import Fidelity, LockTimeout, Yes
from ..runs.approving import approve
from ..runs.clearing import clear_faults
from ..session import Session

HEADING = "The main job"
ORDER = 90

Keys = Annotated[
    list[str] | None, typer.Option("--done", metavar="KEY", help="This step was done before the run ended: you looked.")
]
NotKeys = Annotated[
    list[str] | None, typer.Option("--not-done", metavar="KEY", help="This step was not done: you looked.")
]


def recover(
    context: typer.Context, done: Keys = None, not_done: NotKeys = None, auto_approve: Yes = False,
    fidelity: Fidelity = None, lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Clear faults; set down what hands hold; settle what only you know.

    For after a run was stopped or killed, or a device came to a fault. Each fault is named with what to check at the
    table, and cleared once you confirm it; --yes does not answer that. Changes nothing else. `pico resume` and the next
    `pico apply` set down what hands hold before they go on, but clear no fault that a person must look at.

    Examples:
      pico recover
      pico recover --done 20260101T120000Z-1a2b3c/op3/1
    """
    session = Session.of(context)
    bench = session.bench(fidelity, writing=True, safety="hands")
    if code := clear_faults(session, bench):
        return code
    for keys, was_done in ((done, True), (not_done, False)):
        for key in keys or ():
            bench.recovery.answer(key, done=was_done)
    questions = bench.recovery.open_questions()
    if questions:
        session.report(questions)
        return ExitCode.ERROR
    return approve(session, bench, bench.recovery.recover_plan(), auto_approve)
