"""The simulator, and the rest, 13: `pico version`."""

from __future__ import annotations

import typer

from ..session import Session
from ..views import version as view


def version(context: typer.Context) -> None:
    """Show the versions of PICO and what it stands on."""
    Session.of(context).show(view)
