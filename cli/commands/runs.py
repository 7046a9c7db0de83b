"""History, 10: `pico runs`: what was done on the bench, as the commits carry it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..session import Session
from ..views import compared
from ..views import recorded as view
from ..views import runs as table

if TYPE_CHECKING:
    from pico.diagnostics import Diagnostic

app = typer.Typer(
    rich_markup_mode=None, no_args_is_help=True, help="List the runs that commits carry, show one, or compare two."
)
Run = Annotated[
    str | None, typer.Argument(metavar="RUN", help="The beginning or the end of its id; without it the last run.")
]


@app.command(name="list")
def list_(
    context: typer.Context,
    revision: Annotated[
        str | None, typer.Argument(metavar="REV|A..B", help="Of the history of this; without it of HEAD.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Of all branches and tags.")] = False,
    component: Annotated[
        str | None, typer.Option("--component", metavar="COMPONENT", help="Only those that changed this component.")
    ] = None,
) -> None:
    """List runs, the newest first: what led where, how it ended, and which commit carries it.

    Runs of this bench that no commit has yet are listed, too; the next `pico commit` takes them.
    """
    session = Session.of(context)
    wrong: list[Diagnostic] = []
    history = session.bench().history
    session.show(table, history.runs(revision, every=every, component=component, diagnostics=wrong), wrong)
    session.tell(wrong)


@app.command()
def show(context: typer.Context, run: Run = None) -> None:
    """Show everything about a run: its operations with their times, what it changed, what proves it."""
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
    """Compare two runs: where each ended, the seconds of each operation, and what was otherwise."""
    session = Session.of(context)
    session.show(compared, session.bench().history.compare_runs(a, b))
