"""`pico publish`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, did_you_mean, error

from ..session import Session
from ..views import published as view
from ..waiting import waiting

PICTURES = ("all", "none")


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
        str, typer.Option("--pictures", metavar="all|none", help="With pictures of the table?")
    ] = "all",
) -> int:
    """Write a revision with its runs, measurements, plan and pictures as an RO-Crate, to publish.

    The same commit gives the same bytes. Refused where an artifact of a run is not here.
    """
    from pico.bench.publishing import publish
    from pico.history.lab.folder import LabFolder

    session = Session.of(context)
    if pictures not in PICTURES:
        text = f"--pictures is all or none, not `{pictures[:40]}`"
        raise PicoError(error("usage", text, hint=did_you_mean(pictures, PICTURES)))
    folder = LabFolder(session.folder)
    with waiting("Publishing"):
        path = session.folder / out if out else None
        made = publish(folder, revision, path, runs=run or (), pictures=pictures == "all", beside=session.folder)
    session.show(view, made)
    if not session.json:
        session.report(made.diagnostics)
    return ExitCode.DONE
