"""`pico capture`."""

from __future__ import annotations

import typer

from ..session import Session
from ..views import capture as view


def capture(context: typer.Context) -> int:
    """Write what stands on the bench into the manifest.

    Only values that differ by more than their tolerance change, one line each; comments and layout stay.
    """
    session = Session.of(context)
    bench = session.bench()
    session.show(view, bench.capture())
    return 0
