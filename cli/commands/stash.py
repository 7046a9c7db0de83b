"""`pico stash`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..session import Session
from ..views import stash as view

HEADING = "History"
ORDER = 170

if TYPE_CHECKING:
    from pico.bench.bench import Bench


def stash(
    context: typer.Context,
    action: Annotated[
        Literal["push", "pop", "list", "drop"],
        typer.Argument(metavar="[push|pop|list|drop]", help="push, where nothing is said."),
    ] = "push",
    name: Annotated[str, typer.Argument(metavar="[N]", help="Which edits: 0 the last ones, 1 those before.")] = "",
    message: Annotated[str, typer.Option("-m", "--message", help="What to call the edits that are shelved.")] = "",
) -> None:
    """Shelve the edits of the manifests, or bring them back.

    The bench is not shelved: nothing moves. The edits of this lab's manifests go into git's stash. `pico plan` then
    shows what the bench has that the files have not. Edits of tunables that were changed since are not brought back,
    but named.

    Examples:
      pico stash -m "half an idea"
      pico stash pop
    """
    session = Session.of(context)
    bench = session.bench(writing=action != "list")
    if action == "list":
        session.show(view, action, bench.history.stash.shelves())
        return
    if action == "push":
        shelf = bench.history.stash.push(message or name)
    else:
        shelf = bench.history.stash.pop(name) if action == "pop" else bench.history.stash.drop(name)
    apart = _apart(bench) if shelf and action != "drop" else None
    session.show(view, action, (shelf,) if shelf else (), apart=apart)


def _apart(bench: Bench) -> tuple[int, int]:
    """Return how many components of the bench are not as the manifests now say, and of how many."""
    rows = bench.status().rows
    return len({row.component for row in rows if row.off or row.note}), len({row.component for row in rows})
