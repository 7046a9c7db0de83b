"""`pico diff`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import Revision, Scoped, scope_of
from ..session import Session
from ..terminal.paging import paged
from ..views import diff as view

HEADING = "History"
ORDER = 40

CLASS = Scoped
From = Annotated[
    str | None,
    typer.Argument(
        metavar="[REV|A..B|A...B]", help="A revision (HEAD without one), or a range; A...B: from where B left A."
    ),
]
Picture = Annotated[
    Path | None, typer.Option("--picture", metavar="PNG", help="Draw it from above: A, and dashed where parts go.")
]
Result = Annotated[
    str | None, typer.Option("--budget", metavar="CLAIM|EXPRESSION", help="What it does to a result and its errors.")
]


def diff(
    context: typer.Context,
    a: From = None,
    b: Revision = None,
    picture: Picture = None,
    budget: Result = None,
    stat: Annotated[bool, typer.Option("--stat", help="A line a component, and the tally.")] = False,
    exit_code: Annotated[bool, typer.Option("--exit-code", help="Exit with 1 where anything differs.")] = False,
) -> int:
    """Show what differs between two states, as motions.

    Without arguments: from the last commit to the manifest. With one: from A to the manifest. With names after `--` of
    these components, tunables or files alone. Differences are exact, however small; `pico plan` knows tolerances and
    the bench.

    Examples:
      pico diff
      pico diff e1 e2 -- p2
    """
    session = Session.of(context)
    history = session.history()
    names = scope_of(context)
    found = history.compare(a, b, names, at=session.folder)
    step = (
        f"`pico plan {found.b}` shows how the bench would get there."
        if found.b
        else "`pico plan` shows how it would be done."
    )
    both = session.bench().light.budgets(budget, found.a, found.b) if budget else ()
    with paged(session):
        session.show(
            view, found, a=history.name_of(found.a), b=history.name_of(found.b) if found.b else "the manifest",
            next_step="" if names else step, stat=stat, budgets=(budget, *both) if both else None,
        )  # fmt: skip
    session.draw(
        picture, "the difference", lambda path: session.bench().pictures.render_diff(found.a, found.b, out=path)
    )
    return int(exit_code and not found.same)
