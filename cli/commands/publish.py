"""History, 19: `pico publish`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from ..session import Session
from ..terminal.waiting import waiting
from ..views import published as view


def publish(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="A commit, branch or tag.")] = "HEAD",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR|FILE.zip", help="A new folder or zip file; without it LAB-COMMIT.zip."),
    ] = None,
    run: Annotated[
        list[str] | None,
        typer.Option(
            "--run", metavar="RUN", help="This run of REV instead of those that led to it; may be given again."
        ),
    ] = None,
    pictures: Annotated[
        Literal["all", "none"], typer.Option("--pictures", metavar="all|none", help="With pictures of the table?")
    ] = "all",
) -> None:
    """Write a revision with its runs, measurements, plan and pictures as an RO-Crate, to publish.

    The same commit gives the same bytes. Refused where an artifact of a run is not here.
    """
    from pico.bench.publishing import publish
    from pico.history.lab.folder import LabFolder

    session = Session.of(context)
    folder = LabFolder(session.folder)
    with waiting("Publishing"):
        path = session.folder / out if out else None
        made = publish(folder, revision, path, runs=run or (), pictures=pictures == "all", beside=session.folder)
    session.show(view, made)
    session.tell(made.diagnostics)
