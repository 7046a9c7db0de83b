"""`pico stop`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import stopped as view

HEADING = "The main job"
ORDER = 50

Now = Annotated[bool, typer.Option("--now", help="Stop at once: arms brake, shutters close, grippers hold.")]


def stop(context: typer.Context, now: Now = False) -> None:
    """Stop the run that goes on, from any terminal.

    As Ctrl-C in its own would. Nothing more starts; a part in the hand goes to its goal or back, whichever is sooner.
    It asks the bench to stop, needs nobody's leave, and is no emergency stop: that is the button beside the table.

    Examples:
      pico stop
      pico stop --now
      pico stop --bench shel/bench1
    """
    from pico.bench.running.stopping import moved_elsewhere, stop

    session = Session.of(context)
    place = session.place(session.root(safety=True))
    stopped = stop(place, now=now)
    others = () if stopped[0] else moved_elsewhere(place)
    session.show(view, *stopped, bench=place.title, others=others, now=now)
