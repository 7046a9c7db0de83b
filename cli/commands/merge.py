"""`pico merge`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import merge as view

HEADING = "History"
ORDER = 110


def merge(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="The commit, branch or tag to be merged.")],
    message: Annotated[str, typer.Option("-m", "--message", help="Why.")] = "",
) -> None:
    """Merge another branch, value by value, if the table can take it.

    Nothing is written where a tunable was changed on both sides, or where the merged state is physically impossible
    (exit 3). Nothing moves: `pico plan` then shows what would.

    Examples:
      pico merge e2 -m "both lenses"
    """
    session = Session.of(context)
    made = session.bench(writing=True).history.merge(revision, message)
    session.tell(made.diagnostics)
    session.show(view, made)
