"""`pico blame`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..terminal.paging import paged
from ..views import blame as view

HEADING = "History"
ORDER = 60


def blame(
    context: typer.Context,
    what: Annotated[
        list[str] | None,
        typer.Argument(metavar="COMPONENT[.TUNABLE]...", help="Only these; all where none is given."),
    ] = None,
    at: Annotated[str | None, typer.Option("--at", metavar="REV", help="The state of a revision.")] = None,
    history: Annotated[
        bool, typer.Option("--history", "--all", help="Every commit that changed it, newest first.")
    ] = False,
) -> None:
    """Say for each tunable which commit changed it last, and how.

    Without --at: the state at HEAD, and what was edited since. How: by which run; by hand, where the bench was
    captured and no run had changed it; planned, where a commit says that an edit was never realized. A component is
    known by its name: moving it to another file changes nothing, nor do comments, nor writing a value in another unit.

    Examples:
      pico blame p1
      pico blame p1.angle --history
    """
    from pico.history.blame.blamed import blame as blamed
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    found = blamed(root, what or (), at=at, history=history)
    with paged(session):
        session.show(view, found, asked=bool(what))
    session.tell(found.diagnostics)
