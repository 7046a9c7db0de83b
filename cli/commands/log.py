"""`pico log`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Revision
from ..session import Session
from ..views import log as view


def log(
    context: typer.Context,
    revision: Revision = None,
    graph: Annotated[bool, typer.Option("--graph", help="Draw the branches; shows all of them.")] = False,
    oneline: Annotated[bool, typer.Option("--oneline", help="One line a commit.")] = False,
    every: Annotated[bool, typer.Option("--all", help="Show all branches and tags, not only HEAD.")] = False,
    number: Annotated[int | None, typer.Option("-n", "--number", min=1, help="At most so many commits.")] = None,
) -> int:
    """List commits with what each changed on the table."""
    session = Session.of(context)
    bench = session.bench()
    entries = bench.log(revision, every=every or (graph and revision is None), limit=number)
    session.show(view, entries, graph=graph, oneline=oneline, head=bench.head_commit())
    return 0
