"""The simulator, and the rest, 8: `pico markers`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from pico.disk import write_whole

from ..session import Session
from ..views import markers as view


def markers(
    context: typer.Context,
    out: Annotated[Path, typer.Option("--out", metavar="PDF", help="Where the sheets go.")] = Path("markers.pdf"),
    paper: Annotated[
        Literal["a4", "letter"], typer.Option("--paper", metavar="a4|letter", help="What they are printed on.")
    ] = "a4",
) -> None:
    """Write the markers of the lab as a PDF, to print and stick on.

    Parts, datums, and the board that `pico calibrate` needs. Print at 100 %.
    """
    from pico.vision.sheets import labels, marker_sheets

    session = Session.of(context)
    setup = session.bench().setup
    path = session.folder / out
    write_whole(path, marker_sheets(setup, paper))
    session.show(view, path, shown=out, labels=labels(setup), paper=paper)
