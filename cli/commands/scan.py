"""The simulator, and the rest, 4: `pico scan`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..session import Session
from ..terminal.waiting import waiting
from ..views import scan as view

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
        look = bench.cameras.scan()
    session.show(view, bench.setup, look)
    session.tell(look.observation.problems)
    session.draw(picture, "what the cameras see", lambda path: bench.cameras.picture(look, out=path))
    wrong = any(problem.severity == "error" for problem in look.observation.problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE
