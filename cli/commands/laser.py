"""`pico laser`: what lets lasers emit."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

import typer

from pico.base import clock
from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Fidelity, LockTimeout, Yes, group
from ..session import Session
from ..views import laser as view

HEADING = "One operation at a time"
ORDER = 70

app = group(
    help="Show the lasers, arm one above class 2, or shut it.",
    examples=("pico laser", "pico laser arm laser --hours 2", "pico laser disarm laser"),
    alone=True,
)

Name = Annotated[str, typer.Argument(metavar="LASER", help="A laser of the inventory.")]
Hours = Annotated[float, typer.Option("--hours", metavar="H", help="How long; an hour where nothing is said.")]
Class = Annotated[
    Literal["1", "2", "3R", "3B", "4"] | None,
    typer.Option("--class", metavar="CLASS", help="The greatest that it may emit as; else what it is set to."),
]
Role = Annotated[str | None, typer.Option("--role", help="In which role of the policy; else the first that may.")]
Unattended = Annotated[bool, typer.Option("--unattended", help="For runs that nobody watches: nothing opens now.")]
From = Annotated[str | None, typer.Option("--from", metavar="TIME", help="When it begins: 22:00, or ISO 8601.")]


@app.callback()
def show(context: typer.Context, fidelity: Fidelity = None) -> None:
    """Show each laser: its class, whether it emits, its shutter, and what lets it."""
    if context.invoked_subcommand is None:
        session = Session.of(context)
        lasers = session.bench(fidelity, safety="light").lasers
        rows = lasers.rows()
        session.tell(lasers.notices)
        session.show(view, rows)


@app.command()
def arm(
    context: typer.Context, laser: Name, hours: Hours = 1.0, laser_class: Class = None, role: Role = None,
    unattended: Unattended = False, begins: From = None, fidelity: Fidelity = None, auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Let a laser emit for some hours, and open it once the beam audit passes.

    You are Git's user.name, and must be in a role of `policy: arming: roles:` for its class and that long. At the end
    it is shut by the next command that has the bench, or the one that has it then. `pico undo` shuts it. With
    --unattended later runs open it. Exit code 7: you may not, or its light is not safe.

    Examples:
      pico laser arm laser --hours 2
      pico laser arm laser --unattended --from 22:00 --hours 8
    """
    from ..runs import approving
    from ..runs.running import ran

    if begins and not unattended:
        raise PicoError(error("usage", "--from goes with --unattended", hint="what is opened now begins now"))
    session = Session.of(context)
    bench = session.bench(fidelity, writing=True)
    given = bench.lasers.arming(
        laser, hours=hours, laser_class=laser_class, role=role, begins=_time(begins), unattended=unattended
    )
    if unattended:
        session.require_answer(auto_approve)
        if not session.confirm(f"{view.sentence(given)}, for runs that nobody watches?", auto_approve):
            return ExitCode.ERROR
        session.show(view, bench.lasers.rows()) if bench.lasers.keep(given) else None
        return ExitCode.DONE
    plan = bench.lasers.plan(given)
    session.require_answer(auto_approve)
    if code := approving.show(session, bench, plan, auto_approve, single=True):
        return int(code)
    if not session.confirm(f"{view.sentence(given)}?", auto_approve):
        session.say("Not armed: it stays as it is.")
        return ExitCode.ERROR
    report = bench.lasers.open(given, plan, lambda made: ran(session, bench, made, after=view.AFTER))
    if report is None:
        session.say(f"{view.sentence(given)}; it emits already.")
    return int(report.exit_code) if report else ExitCode.DONE


@app.command()
def disarm(context: typer.Context, laser: Name, fidelity: Fidelity = None) -> int:
    """Shut a laser at once, whoever has the bench, and end what armed it.

    Nobody is asked. Where a run goes on, that shuts it, and what then needs its light is dark.

    Examples:
      pico laser disarm laser
    """
    from pico.places.lab import lenient

    session = Session.of(context)
    context.with_resource(lenient())
    bench = session.bench(fidelity, writing=True, safety="light")
    if bench.lasers.disarm(laser):
        session.show(view, bench.lasers.rows())
        return ExitCode.DONE
    hint = "look at it, and shut it by hand"
    raise PicoError(error("laser", f"{laser} is disarmed, and nobody has shut it yet", hint=hint, address=laser))


def _time(text: str | None) -> datetime | None:
    """Return a time of day, the next there is, or one in ISO 8601; here where it names no zone."""
    if text is None:
        return None
    try:
        if ":" in text and "T" not in text and " " not in text:
            return view.next_time(text)
        return clock.parse(text).astimezone()
    except ValueError:
        hint = "write 22:00, or 2026-11-24T22:00"
        raise PicoError(error("usage", f"`{text[:40]}` is no time", hint=hint)) from None
