"""`pico revert`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import Mainline, NoCommit
from ..session import Session
from ..views import transplanted as view

HEADING = "History"
ORDER = 130


def revert(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="The commit whose change is taken back.")],
    message: Annotated[str, typer.Option("-m", "--message", help="Why; without it 'Revert \"...\"'.")] = "",
    mainline: Mainline = None,
    no_commit: NoCommit = False,
) -> None:
    """Take back in the manifests what a commit changed on the table.

    Later changes of other tunables stay, and so do the runs and notes of that commit. Nothing is written where the
    same tunable was changed since, or where the result is physically impossible (exit 3). Nothing moves: `pico plan`
    then shows what would.

    Examples:
      pico revert E1-3 -m "too steep"
    """
    if message.strip().isdecimal():
        raise PicoError(error("usage", f"-m is the message; the side of a merge is `--mainline {message.strip()}`"))
    session = Session.of(context)
    bench = session.bench(writing=True)
    before = bench.history.head_commit()
    done = bench.history.revert(revision, message, mainline=mainline, commit=not no_commit)
    session.tell(done.diagnostics)
    session.show(view, (done,), before=before or "")
