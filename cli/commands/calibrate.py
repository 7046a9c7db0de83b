"""The simulator, and the rest, 7: `pico calibrate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from pico.disk import write_whole

from ..arguments import group
from ..session import Session
from ..views import calibration as view
from ..views import markers as sheets

app = group(
    help="Find out where cameras and arms are; print the markers.",
    examples=("pico calibrate", "pico calibrate markers --paper letter"),
    alone=True,
)


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        cameras(context)


@app.command()
def cameras(context: typer.Context) -> None:
    """Find out where the cameras are, how their lenses draw and how the arms are built.

    From pictures of the datums and of the calibration board, held up by a person and by the arms, and from the arms'
    encoders; takes about half a minute. Writes calibration.json into the lab's folder. Nothing on the table moves.
    `pico calibrate` alone is the same.
    """
    from pico.vision.calibration import FILE

    session = Session.of(context)
    bench = session.bench(writing=True)
    session.say("Taking pictures of the calibration board (about half a minute) ...")
    session.show(view, bench.cameras.calibrate(), shown=FILE)


@app.command()
def markers(
    context: typer.Context,
    out: Annotated[Path, typer.Option("--out", metavar="PDF", help="Where the sheets go.")] = Path("markers.pdf"),
    paper: Annotated[
        Literal["a4", "letter"], typer.Option("--paper", metavar="a4|letter", help="What they are printed on.")
    ] = "a4",
) -> None:
    """Write the markers of the lab as a PDF, to print and stick on.

    Parts, datums, and the board that `pico calibrate` needs. Print at 100 %.

    Examples:
      pico calibrate markers --paper letter
    """
    from pico.vision.sheets import labels, marker_sheets

    session = Session.of(context)
    setup = session.bench().setup
    path = session.folder / out
    write_whole(path, marker_sheets(setup, paper))
    session.show(sheets, path, shown=out, labels=labels(setup), paper=paper)
