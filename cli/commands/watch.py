"""History, 20: `pico watch`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..arguments import Yes
from ..session import Session
from ..views import watched as view

Interval = Annotated[float, typer.Option("--interval", metavar="SECONDS", help="Between two looks.", min=0)]
Looks = Annotated[int | None, typer.Option("--looks", metavar="N", help="End after N looks.", min=1)]
Heal = Annotated[
    bool,
    typer.Option("--heal", help="Bring back what drifted and no operation moved, where the lab's policy allows it."),
]


def watch(
    context: typer.Context,
    interval: Interval = 10.0,
    looks: Looks = None,
    heal: Heal = False,
    auto_approve: Yes = False,
) -> int:
    """Look at the bench again and again, and tell what leaves the last commit and what comes back.

    Moves nothing without --heal and needs no lock; Ctrl-C ends it. With --heal nothing is moved while somebody is at
    the table or a run goes on, nor where it is the calibration that seems to have drifted. With --json a line a change.
    """
    session = Session.of(context)
    bench = session.bench(writing=heal)
    session.require_answer(auto_approve or not heal)
    asked = f"Bring back what drifts on {bench.backend_name} ({bench.fidelity}), each time without asking again?"
    if heal and not session.confirm(asked, auto_approve):
        session.say("Nothing moved.")
        return ExitCode.ERROR
    try:
        for told in bench.drift.watch(interval=interval, looks=looks, heal=heal):
            if told.new:
                session.show(view, told)
            elif told.first:
                session.say(view.right(told))
    except KeyboardInterrupt:
        session.say("\nStopped watching; the bench is as it was." if not heal else "\nStopped watching.")
    return ExitCode.DONE
