"""`pico calibrate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from pico.disk import write_whole

from ..arguments import group
from ..session import Session
from ..terminal.waiting import waiting
from ..views import calibration as view
from ..views import lesson
from ..views import markers as sheets

HEADING = "The simulator, and the rest"
ORDER = 80

app = group(
    help="Find out where cameras and arms are; print the markers.",
    examples=("pico calibrate", "pico calibrate twin --dry-run", "pico calibrate markers --paper letter"),
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
    encoders; takes about half a minute. Writes calibration/sim.json in the lab's folder. Nothing on the table moves.
    `pico calibrate` alone is the same.
    """
    session = Session.of(context)
    bench = session.bench(writing=True)
    session.say("Taking pictures of the calibration board (about half a minute) ...")
    session.show(view, bench.cameras.calibrate(), shown="calibration/sim.json")


@app.command()
def twin(
    context: typer.Context,
    runs: Annotated[
        list[str] | None,
        typer.Argument(metavar="RUN|A..B...", help="Ids of runs, or those of a range; without any the bench's own."),
    ] = None,
    since: Annotated[
        str | None, typer.Option("--since", metavar="DAY", help="Only from runs begun then or later (UTC).")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show it, and write nothing.")] = False,
) -> None:
    """Let the twin learn from recorded runs how the bench errs.

    How parts come to stand that are put down, by type; how long operations take; how what cameras see scatters. Told
    beside each other: what the twin said before, what was measured, what it says now. Writes twin.json into the lab's
    folder: the simulator reads it, plans do not. Without RUN all runs on hardware, or, where there are none, with
    emulated devices.

    Examples:
      pico calibrate twin --since 2026-11-01
      pico calibrate twin e1..e2 --dry-run
    """
    from pico.twin.learned import FILE

    session = Session.of(context)
    bench = session.bench(writing=not dry_run)
    with waiting("Learning"):
        found = bench.twin.learn(*(runs or ()), since=since, write=not dry_run)
    session.show(lesson, found, shown=FILE)
    session.tell(found.diagnostics)


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
