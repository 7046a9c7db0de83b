"""History, 2: `pico note`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import note as view


def note(
    context: typer.Context,
    part: Annotated[str, typer.Argument(metavar="PART", help="A part of the inventory.")],
    text: Annotated[list[str] | None, typer.Argument(metavar="[TEXT]...", help="What there is to say of it.")] = None,
) -> None:
    """Note something on a part, or list what was noted on it.

    Notes are lines of `notes/PART.md`; the next `pico commit` takes them along, and merges keep those of both sides.
    """
    session = Session.of(context)
    bench = session.bench(writing=bool(text))
    added = bench.history.note(part, " ".join(text)) if text else None
    session.show(view, part, bench.history.notes(part), added)
