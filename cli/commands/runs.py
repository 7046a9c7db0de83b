"""History, 10: `pico runs`: what was done on the bench, as the commits carry it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..arguments import Scoped, group, scope_of
from ..session import Session
from ..terminal.waiting import waiting
from ..views import compared, published
from ..views import recorded as view
from ..views import runs as table

if TYPE_CHECKING:
    from pico.diagnostics import Diagnostic

app = group(
    help="List, show, compare and export the runs that commits carry.",
    examples=("pico runs", "pico runs list main..e1 -- p2", "pico runs show", "pico runs export e1 --out e1.zip"),
    alone=True,
)
Run = Annotated[
    str | None, typer.Argument(metavar="RUN", help="The beginning or the end of its id; without it the last run.")
]


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_(context)


@app.command("list", cls=Scoped)
def list_(
    context: typer.Context,
    revision: Annotated[
        str | None, typer.Argument(metavar="REV|A..B", help="Of the history of this; without it of HEAD.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Of all branches and tags.")] = False,
) -> None:
    """List runs, the newest first; `pico runs` alone does the same.

    What led where, how it ended, and which commit carries it; those that no commit has yet, too: the next `pico
    commit` takes them. With names after `--` only what changed these components or tunables.

    Examples:
      pico runs list main..e1 -- p2
    """
    session = Session.of(context)
    wrong: list[Diagnostic] = []
    history = session.bench().history
    session.show(table, history.runs(revision, every=every, components=scope_of(context), diagnostics=wrong), wrong)
    session.tell(wrong)


@app.command()
def show(context: typer.Context, run: Run = None) -> None:
    """Show a run: its operations, what it changed, what proves it.

    Examples:
      pico runs show
    """
    session = Session.of(context)
    found, commit = session.bench().history.recorded_run(run)
    session.show(view, found, commit)
    session.tell(found.diagnostics)


@app.command()
def compare(
    context: typer.Context,
    a: Annotated[str, typer.Argument(metavar="A", help="The beginning of a run's id.")],
    b: Annotated[str, typer.Argument(metavar="B", help="The beginning of another's.")],
) -> None:
    """Compare two runs: where each ended, how long, what was otherwise.

    Examples:
      pico runs compare 20260101 20260102
    """
    session = Session.of(context)
    session.show(compared, session.bench().history.compare_runs(a, b))


@app.command()
def export(
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
    """Write a revision with its runs and pictures as an RO-Crate.

    Runs, measurements, plan and pictures of the table, to publish. The same commit gives the same bytes. Refused where
    an artifact of a run is not here.

    Examples:
      pico runs export e1 --out e1.zip
    """
    from pico.bench.publishing import publish
    from pico.history.lab.folder import LabFolder

    session = Session.of(context)
    folder = LabFolder(session.folder)
    with waiting("Publishing"):
        path = session.folder / out if out else None
        made = publish(folder, revision, path, runs=run or (), pictures=pictures == "all", beside=session.folder)
    session.show(published, made)
    session.tell(made.diagnostics)
