"""`pico init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..session import Session
from ..views import started as view

HEADING = "The main job"
ORDER = 10


def init(
    context: typer.Context,
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="The folder, this one if not given; files in it stay. For an example, an empty or new one.",
        ),
    ] = Path(),
    example: Annotated[
        str | None,
        typer.Option("--example", metavar="minimal|shel|mach_zehnder|crowded|two_arms", help="With its history."),
    ] = None,
) -> None:
    """Make a new lab, or an example with its history.

    Examples:
      pico init mybench
      pico init --example shel bench
    """
    from pico.bench.bench import new_lab

    session = Session.of(context)
    notes = new_lab(session.folder / folder, example)
    session.wire(session.folder / folder)
    session.show(view, session.folder / folder, example, shown=folder)
    session.tell(notes)
