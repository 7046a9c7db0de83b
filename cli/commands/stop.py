"""The main job, 5: `pico stop`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import stopped as view

Now = Annotated[bool, typer.Option("--now", help="Stop at once: arms brake, shutters close, grippers hold.")]


def stop(context: typer.Context, now: Now = False) -> None:
    """Stop the run that goes on, from any terminal.

    As Ctrl-C in its own would. Nothing more starts; a part in the hand goes to its goal or back, whichever is sooner.

    Examples:
      pico stop
      pico stop --now
    """
    from pico.bench.running.stopping import stop

    session = Session.of(context)
    session.show(view, *stop(session.folder, now=now))
