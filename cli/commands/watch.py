"""`pico watch`."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError

from ..session import Session
from ..views import watched as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.drift import Drift, Drifted

Interval = Annotated[float, typer.Option("--interval", metavar="SECONDS", help="Between two looks.", min=0)]
Looks = Annotated[int | None, typer.Option("--looks", metavar="N", help="End after N looks.", min=1)]
Heal = Annotated[
    bool,
    typer.Option("--heal", help="Bring back what drifted and no operation moved, where the lab's policy allows it."),
]


def watch(context: typer.Context, interval: Interval = 10.0, looks: Looks = None, heal: Heal = False) -> int:
    """Look at the bench again and again, and tell what leaves the last commit and what comes back.

    Moves nothing without --heal and needs no lock; Ctrl-C ends it. With --heal nothing is moved while somebody is at
    the table or a run goes on, nor where it is the calibration that seems to have drifted. With --json a line a change.
    """
    session = Session.of(context)
    bench = session.bench(writing=heal)
    if heal:
        from pico.bench.drift import require_heal

        require_heal(bench.setup)
    before: tuple[Drift, ...] = ()
    tried: set[str] = set()
    done, over = 0, threading.Event()
    try:
        while looks is None or done < looks:
            if done:
                over.wait(interval)
            found = bench.look()
            note = _heal(bench, found, tried) if heal else ""
            _tell(session, found, before, note, first=not done)
            before, done = found.beyond, done + 1
    except KeyboardInterrupt:
        session.say("\nStopped watching; the bench is as it was." if not heal else "\nStopped watching.")
    return ExitCode.DONE


def _tell(session: Session, found: Drifted, before: tuple[Drift, ...], note: str, *, first: bool) -> None:
    from pico.bench.drift import news

    fresh, right = news(before, found.beyond)
    if fresh or right or note:
        session.show(view, found, fresh, right, note)
    elif first:
        session.say(f"No drift: the bench is as {found.head} says. Watching; Ctrl-C ends it.")


def _heal(bench: Bench, found: Drifted, tried: set[str]) -> str:
    """Bring back what drifted, once for each thing that happens; return what became of it."""
    now = {f"{d.address} {d.change.text}" for d in found.beyond if d.by != "operation"}
    if not now - tried:
        return ""
    if found.held:
        key = f"held: {found.held}"
        said = "" if key in tried else f"not healed: {found.held}"
        tried.add(key)
        return said
    tried.clear()
    tried |= now
    try:
        report = bench.heal(found)
    except PicoError as exc:
        return f"not healed: {exc.diagnostics[0].summary}"
    if report is None:
        return ""
    return (
        f"healed: {report.done} operations" if report.exit_code == 0 else f"healing {report.outcome}: run {report.run}"
    )
