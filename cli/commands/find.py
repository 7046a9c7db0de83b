"""`pico find`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode
from pico.model.request import require_component

from ..arguments import Component
from ..session import Session
from ..views import find as view
from ..views import picture as picture_view
from ..waiting import waiting

Picture = Annotated[
    Path | None, typer.Option("--picture", metavar="PNG", help="What a camera sees around it, with names drawn in.")
]


def find(context: typer.Context, part: Component, picture: Picture = None) -> int:
    """Show where a part is, as the cameras see it now.

    Its pose, the nearest hole of the table, its slot, how surely. Exits with 1 where nobody sees it; then says where it
    was last.
    """
    session = Session.of(context)
    bench = session.bench()
    require_component(bench.setup, part)
    with waiting("Looking"):
        look = bench.scan()
    found = look.observation.components[part]
    problems = [p for p in look.observation.problems if p.address in (part, "") or part in p.summary.split(":")[0]]
    session.show(view, bench.setup, part, found, problems)
    if not session.json:
        session.report([p for p in problems if p.severity != "note"])
    if picture and found.pose is not None:
        bench.scan_picture(look, out=session.folder / picture, component=part)
        session.say(picture_view.text(session.folder / picture, shown=picture, what=f"what is around {part}"))
    wrong = found.pose is None or any(p.severity == "error" for p in problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE
