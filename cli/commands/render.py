"""`pico render`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import PicoError, did_you_mean, error

from ..arguments import Revision
from ..session import Session
from ..views import picture as view

VIEWS = ("perspective", "top")


def render(
    context: typer.Context,
    revision: Revision = None,
    out: Annotated[Path, typer.Option("--out", metavar="PNG", help="Where the picture goes.")] = Path("bench.png"),
    looking: Annotated[str, typer.Option("--view", metavar="perspective|top", help="From where.")] = "perspective",
    plan: Annotated[
        bool, typer.Option("--plan", help="Show what would move on the way to REV or the manifest.")
    ] = False,
) -> int:
    """Draw the bench as a PNG.

    As it is, or as a revision wants it. Needs no OpenGL.
    """
    session = Session.of(context)
    bench = session.bench()
    if looking not in ("perspective", "top"):
        raise PicoError(error("usage", f"there is no view `{looking}`", hint=did_you_mean(looking, VIEWS)))
    if plan and looking != "top":
        raise PicoError(error("usage", "what would move is drawn from above only", hint="add `--view top`"))
    path = session.folder / out
    bench.render(revision, view="top" if looking == "top" else "perspective", plan=plan, out=path)
    goal = bench.name_of(revision) if revision else "the manifest"
    what = (
        f"the bench as it is, and dashed where parts go for {goal}"
        if plan
        else goal
        if revision
        else "the bench as it is"
    )
    session.show(view, path, shown=out, what=what)
    return 0
