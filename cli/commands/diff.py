"""`pico diff`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import Revision
from ..session import Session
from ..views import diff as view
from ..views import picture as picture_view
from ..waiting import waiting

Picture = Annotated[
    Path | None, typer.Option("--picture", metavar="PNG", help="Draw it from above: A, and dashed where parts go.")
]


def diff(context: typer.Context, a: Revision = None, b: Revision = None, picture: Picture = None) -> int:
    """Show what differs between two states, as motions.

    Without arguments: from the last commit to the manifest. With one: from A to the manifest. Differences are exact,
    however small; `pico plan` knows tolerances and the bench.
    """
    session = Session.of(context)
    bench = session.bench()
    step = f"`pico plan {b}` shows how the bench would get there." if b else "`pico plan` shows how it would be done."
    session.show(
        view,
        bench.diff(a, b),
        a=bench.name_of(a or "HEAD"),
        b=bench.name_of(b) if b else "the manifest",
        next_step=step,
    )
    if picture:
        with waiting("Drawing"):
            bench.render_diff(a, b, out=session.folder / picture)
        session.say(f"\n{picture_view.text(session.folder / picture, shown=picture, what='the difference')}")
    return 0
