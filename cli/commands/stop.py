"""`pico stop`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error

from ..session import Session
from ..views import stopped as view

HEADING = "The main job"
ORDER = 50

Now = Annotated[bool, typer.Option("--now", help="Stop at once: arms brake, grippers hold, all light ends.")]


def stop(context: typer.Context, now: Now = False) -> int:
    """Stop the run that goes on, from any terminal.

    As Ctrl-C in its own would. Nothing more starts; a part in the hand goes to its goal or back, whichever is sooner.
    With --now arms brake where they are, shutters close and lasers are switched off, whether or not anything moves; it
    says what became of each laser, and ends with exit code 1 if one may still emit. It asks the bench to stop, needs
    no lease, and is no emergency stop: that is the button beside the table.

    Examples:
      pico stop
      pico stop --now
      pico stop --bench shel/bench1
    """
    from pico.bench.running.stopping import end_light, moved_elsewhere, stop
    from pico.places.lab import lenient

    session = Session.of(context)
    context.with_resource(lenient())
    place = session.place(session.root(safety=True), safety=True)
    ended, wrong = None, list[Diagnostic]()
    failed: PicoError | None = None
    for work in ("light", "motion", "light") if now else ("motion",):  # a run may let light out until it has stopped
        if work == "motion":
            try:
                stopped = stop(place, now=now)
            except PicoError as exc:  # light is ended all the same
                failed = exc
            continue
        try:
            ended = end_light(place)
            wrong = []
        except PicoError as exc:
            wrong = list(exc.diagnostics)
    if failed is not None:
        raise PicoError([*failed.diagnostics, *wrong], failed.exit_code)
    others = () if stopped[0] else moved_elsewhere(place)
    session.show(view, *stopped, bench=place.title, others=others, now=now, light=ended)
    if wrong:
        raise PicoError([error("stop", "light was not ended: see what follows", hint=view.BY_HAND), *wrong])
    dark = ended is None or all(one.is_dark for one in ended.ends)
    return ExitCode.DONE if dark else ExitCode.ERROR
