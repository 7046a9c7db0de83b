"""`pico import`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..terminal.waiting import waiting
from ..views import imported as view

HEADING = "The simulator, and the rest"
ORDER = 70

Types = Annotated[
    list[str] | None,
    typer.Option(
        "--types",
        metavar="MARKER=TYPE[:NAME],...",
        help="What the part with a marker is, and what it is to be called; may be given again.",
    ),
]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Say what would be written, and write nothing.")]


def import_(context: typer.Context, types: Types = None, dry_run: DryRun = False) -> None:
    """Take parts on the table that the inventory lacks into it.

    As the cameras see them: an entry into `inventory`, and where they stand into the state, so that `pico plan` has
    nothing to do. What is written there stays. A marker of which nothing says the type is asked for, and nothing is
    written.

    Examples:
      pico import --types 5=plano_convex_125:lx_125
    """
    session = Session.of(context)
    bench = session.bench(writing=not dry_run)
    with waiting("Looking"):
        found = bench.lab.import_parts(types or [], write=not dry_run)
    session.show(view, found, dry_run=dry_run)
