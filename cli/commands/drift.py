"""`pico drift`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import DetailedExit, Yes
from ..session import Session
from ..views import drift as view
from ..views import watched

HEADING = "History"
ORDER = 100

if TYPE_CHECKING:
    from pico.bench.bench import Bench

Watch = Annotated[bool, typer.Option("--watch", help="Look again and again; Ctrl-C ends it.")]
Interval = Annotated[float, typer.Option("--interval", metavar="SECONDS", help="Between two looks.", min=0)]
Looks = Annotated[int | None, typer.Option("--looks", metavar="N", help="End after N looks.", min=1)]
Heal = Annotated[
    bool, typer.Option("--heal", help="Bring back what no operation moved, where the lab's policy allows it.")
]


def drift(
    context: typer.Context, detailed_exitcode: DetailedExit = False, watch: Watch = False, interval: Interval = 10.0,
    looks: Looks = None, heal: Heal = False, auto_approve: Yes = False,
) -> int:  # fmt: skip
    """Show where the bench has left the last commit. Moves nothing.

    Each tunable with its tolerance, how surely it was seen, and who changed it last as far as the journal knows.

    With --watch what leaves the commit and what comes back, with --json a line a change. With --heal it asks once,
    then brings back what drifts; but not while somebody is at the table or a run goes on, nor where it is the
    calibration that seems to have drifted.

    Examples:
      pico drift
      pico drift --watch --interval 60
    """
    if not watch and (heal or looks is not None):
        raise PicoError(error("usage", "--interval, --looks and --heal go with --watch"))
    session = Session.of(context)
    bench = session.bench(writing=heal)
    if watch:
        return _watch(session, bench, interval, looks, heal, auto_approve)
    found = bench.drift.look()
    session.tell(found.cut_short)
    session.show(view, found, bench.place.title)
    return ExitCode.CHANGES if detailed_exitcode and found.beyond else ExitCode.DONE


def _watch(session: Session, bench: Bench, interval: float, looks: int | None, heal: bool, auto_approve: bool) -> int:
    session.require_answer(auto_approve or not heal)
    asked = f"Bring back what drifts on {bench.backend_name} ({bench.fidelity}), each time without asking again?"
    if heal and not session.confirm(asked, auto_approve):
        session.say("Nothing moved.")
        return ExitCode.ERROR
    try:
        for told in bench.drift.watch(interval=interval, looks=looks, heal=heal):
            if told.new:
                session.show(watched, told)
            elif told.first:
                session.say(watched.right(told))
    except KeyboardInterrupt:
        session.say("\nStopped watching; the bench is as it was." if not heal else "\nStopped watching.")
    return ExitCode.DONE
