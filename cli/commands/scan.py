"""`pico scan`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..session import Session
from ..views import picture as picture_view
from ..views import scan as view
from ..waiting import waiting

Picture = Annotated[
    Path | None, typer.Option("--picture", metavar="PNG", help="The overhead picture with names drawn in.")
]


def scan(context: typer.Context, picture: Picture = None) -> int:
    """Look at the table through the cameras: where every part is, how surely, and what can't be told.

    Moves nothing and writes nothing into the manifests. Exits with 1 where cameras are dark or have moved, or where a
    part can't be told from another.
    """
    session = Session.of(context)
    bench = session.bench()
    with waiting("Looking"):
        look = bench.scan()
    session.show(view, bench.setup, look)
    if not session.json:
        session.report(look.observation.problems)
    if picture:
        with waiting("Drawing"):
            bench.scan_picture(look, out=session.folder / picture)
        session.say(f"\n{picture_view.text(session.folder / picture, shown=picture, what='what the cameras see')}")
    wrong = any(problem.severity == "error" for problem in look.observation.problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE
