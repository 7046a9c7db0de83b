"""`pico capture`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import capture as view

HEADING = "Manifests"
ORDER = 30


def capture(
    context: typer.Context,
    only: Annotated[
        list[str] | None, typer.Argument(metavar="[COMPONENT[.TUNABLE]]...", help="Write only these.")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show what would be written, and write nothing.")] = False,
) -> None:
    """Write what stands on the bench into the manifest.

    Only values that differ by more than their tolerance change, one line each; comments and layout stay.

    Examples:
      pico capture
      pico capture p2 p1.angle --dry-run
    """
    session = Session.of(context)
    session.show(view, session.bench(writing=not dry_run).capture(*(only or ()), write=not dry_run))
