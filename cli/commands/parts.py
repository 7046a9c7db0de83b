"""Manifests, 5: `pico parts`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import parts as view


def parts(
    context: typer.Context,
    free: Annotated[bool, typer.Option("--free", help="Only those in storage that the manifest does not use.")] = False,
) -> None:
    """List the parts of this bench and where they are."""
    session = Session.of(context)
    session.show(view, session.bench().measurements.parts(free=free), free=free)
