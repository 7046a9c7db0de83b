"""`pico note`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component
from ..session import Session
from ..views import note as view

HEADING = "History"
ORDER = 20


def note(
    context: typer.Context,
    component: Component,
    text: Annotated[list[str] | None, typer.Argument(metavar="[TEXT]...", help="What there is to say of it.")] = None,
) -> None:
    """Note something on a part, or list what was noted on it.

    Notes are lines of `notes/COMPONENT.md`; the next `pico commit` takes them along, and merges keep those of both
    sides.

    Examples:
      pico note p2 "scratched at the rim"
      pico note p2
    """
    session = Session.of(context)
    bench = session.bench(writing=bool(text))
    added = bench.history.note(component, " ".join(text)) if text else None
    session.show(view, component, bench.history.notes(component), added)
