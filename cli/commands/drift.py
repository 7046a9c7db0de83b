"""History, 11: `pico drift`."""

from __future__ import annotations

import typer

from pico.diagnostics import ExitCode

from ..arguments import DetailedExit
from ..session import Session
from ..views import drift as view


def drift(context: typer.Context, detailed_exitcode: DetailedExit = False) -> int:
    """Show where the bench has left the last commit. Moves nothing.

    Each tunable with its tolerance, how surely it was seen, and who changed it last as far as the journal knows. With
    --detailed-exitcode exits with 2 where something has drifted beyond its tolerance.
    """
    session = Session.of(context)
    found = session.bench().drift.look()
    session.tell(found.cut_short)
    session.show(view, found)
    return ExitCode.CHANGES if detailed_exitcode and found.beyond else ExitCode.DONE
