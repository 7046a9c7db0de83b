"""`pico drift`."""

from __future__ import annotations

import typer

from pico.diagnostics import ExitCode

from ..arguments import DetailedExit
from ..session import Session
from ..views import drift as view


def drift(context: typer.Context, detailed_exitcode: DetailedExit = False) -> int:
    """Show where the bench has left the last commit. Moves nothing.

    With --detailed-exitcode exits with 2 where something has drifted beyond its tolerance.
    """
    session = Session.of(context)
    bench = session.bench()
    changes = bench.drift()
    session.show(view, changes, head=bench.head_name())
    beyond = any(not c.tolerated for c in changes)
    return ExitCode.CHANGES if detailed_exitcode and beyond else ExitCode.DONE
