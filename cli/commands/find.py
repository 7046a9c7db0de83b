"""The simulator, and the rest, 5: `pico find`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode
from pico.model.request import require_component

from ..arguments import Component
from ..session import Session
from ..terminal.waiting import waiting
from ..views import find as view

Picture = Annotated[
    Path | None, typer.Option("--picture", metavar="PNG", help="What a camera sees around it, with names drawn in.")
]


def find(context: typer.Context, part: Component, picture: Picture = None) -> int:
    """Show where a part is, as the cameras see it now.

    Its pose, the nearest hole of the table, its slot, how surely. Exits with 1 where nobody sees it; then says where it
    was last.
    """
    from pico.bench.cameras import problems_of

    session = Session.of(context)
    bench = session.bench()
    require_component(bench.setup, part)
    with waiting("Looking"):
        look = bench.cameras.scan()
    found = look.observation.components[part]
    problems = problems_of(look, part)
    session.show(view, bench.setup, part, found, problems)
    session.tell([p for p in problems if p.severity != "note"])
    if found.pose is not None:
        draw = partial(bench.cameras.picture, look, component=part)
        session.draw(picture, f"what is around {part}", lambda path: draw(out=path))
    wrong = found.pose is None or any(p.severity == "error" for p in problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE
