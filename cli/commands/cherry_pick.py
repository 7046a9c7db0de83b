"""`pico cherry-pick`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Mainline, NoCommit
from ..session import Session
from ..views import transplanted as view

HEADING = "History"
ORDER = 140


def cherry_pick(
    context: typer.Context,
    revisions: Annotated[list[str], typer.Argument(metavar="REV...", help="Commits, or a range such as main..e1.")],
    mainline: Mainline = None,
    no_commit: NoCommit = False,
) -> None:
    """Change here in the manifests what commits elsewhere changed.

    A commit each, with its message and author, but without its runs: it was not realized here. Nothing is written
    where a tunable was changed here too, or where a result is physically impossible (exit 3). Nothing moves: `pico
    plan` then shows what would.

    Examples:
      pico cherry-pick E2-2
      pico cherry-pick main..e1 --no-commit
    """
    session = Session.of(context)
    bench = session.bench(writing=True)
    before = bench.history.head_commit()
    done = bench.history.cherry_pick(revisions, mainline=mainline, commit=not no_commit)
    session.tell([d for one in done for d in one.diagnostics])
    session.show(view, done, before=before or "")
