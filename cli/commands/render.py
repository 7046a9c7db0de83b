"""`pico render`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import Revision
from ..session import Session
from ..views import picture as view


def render(
    context: typer.Context,
    revision: Revision = None,
    out: Annotated[Path, typer.Option("--out", metavar="PNG", help="Where the picture goes.")] = Path("bench.png"),
    looking: Annotated[str, typer.Option("--view", metavar="perspective|top", help="From where.")] = "perspective",
    plan: Annotated[
        bool, typer.Option("--plan", help="Show what would move on the way to REV or the manifest.")
    ] = False,
) -> int:
    """Draw the bench as a PNG: as it is, or as a revision wants it. Needs no OpenGL."""
    session = Session.of(context)
    bench = session.bench()
    path = session.folder / out
    path.write_bytes(bench.render(revision, view=looking, plan=plan))
    session.show(view, path, shown=out, what=bench.name_of(revision) if revision else "the bench as it is")
    return 0
