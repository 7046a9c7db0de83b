"""`pico commit`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..session import Session
from ..views import commit as view


def commit(
    context: typer.Context,
    message: Annotated[str, typer.Option("-m", "--message", help="Why.")],
    capture: Annotated[
        bool, typer.Option("--capture", help="Where bench and manifest differ, the bench wins.")
    ] = False,
    planned: Annotated[
        bool, typer.Option("--planned", help="Commit edits that were never applied; the commit says so.")
    ] = False,
) -> int:
    """Capture the bench and commit.

    Refused where the manifest holds edits that were never applied: apply them first, or say who wins with --capture
    or --planned.
    """
    if capture and planned:
        raise PicoError(error("usage", "--capture and --planned contradict each other: one of bench and manifest wins"))
    session = Session.of(context)
    bench = session.bench()
    made = bench.commit(message, mode="capture" if capture else "planned" if planned else "strict")
    session.show(view, made)
    return 0
