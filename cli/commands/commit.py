"""`pico commit`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import PicoError, error

from ..session import Session
from ..views import commit as view

HEADING = "History"
ORDER = 10

if TYPE_CHECKING:
    from pico.bench.commits import CommitMode


def commit(
    context: typer.Context,
    only: Annotated[
        list[str] | None,
        typer.Argument(metavar="[COMPONENT[.TUNABLE]]...", help="Commit only the files that hold these."),
    ] = None,
    message: Annotated[
        list[str] | None, typer.Option("-m", "--message", help="Why; the physical diff without it.")
    ] = None,
    edit: Annotated[bool, typer.Option("-e", "--edit", help="Open the message in git's editor first.")] = False,
    capture: Annotated[
        bool, typer.Option("--capture", help="Where bench and manifest differ, the bench wins.")
    ] = False,
    planned: Annotated[
        bool, typer.Option("--planned", help="Commit edits that were never applied; the commit says so.")
    ] = False,
    meta: Annotated[
        list[str] | None, typer.Option("--meta", metavar="KEY=VALUE", help="Record this, too; may be repeated.")
    ] = None,
    empty: Annotated[bool, typer.Option("--allow-empty", help="Commit also where nothing changed.")] = False,
) -> None:
    """Capture the bench and commit.

    Refused where the manifest holds edits that were never applied: apply them first, or say who wins with --capture or
    --planned. The commit carries the runs that led to its state, and notes. Without -m its message is what moved.

    Examples:
      pico commit -m "p1 three degrees from crossed"
      pico commit --capture --meta temperature=21.3
    """
    if capture and planned:
        raise PicoError(error("usage", "--capture and --planned contradict each other: one of bench and manifest wins"))
    session = Session.of(context)
    recorded = _recorded(meta or [])
    bench = session.bench(writing=True)
    mode: CommitMode = "capture" if capture else "planned" if planned else "strict"
    text = "\n\n".join(message) if message else None
    if edit:
        from ..terminal.editing import edited

        text = edited(bench, text if text is not None else bench.commits.draft(mode, only=only or (), empty=empty))
    made = bench.commits.commit(text, mode, only=only or (), meta=recorded, empty=empty)
    session.tell(made.diagnostics)
    session.show(view, made)


def _recorded(meta: list[str]) -> dict[str, str]:
    """Return what `--meta` gave; raises PicoError for what can't be recorded, before anything else happens."""
    from pico.history.messages.trailers import require_meta

    for word in meta:
        if "=" not in word:
            raise PicoError(error("usage", f"--meta takes key=value, not `{word}`", hint="--meta temperature=21.3"))
    recorded = {key: value.strip() for key, _, value in (word.partition("=") for word in meta)}
    require_meta(recorded)
    return recorded
