"""One operation at a time, 7: `pico get`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component
from ..session import Session
from ..views import values as view


def get(
    context: typer.Context,
    component: Component,
    tunable: Annotated[str | None, typer.Argument(metavar="TUNABLE", help="Without it, all of them.")] = None,
) -> None:
    """Read the tunables of a component.

    Pose included, as they are on the bench.
    """
    session = Session.of(context)
    session.show(view, session.bench().read(component, tunable), component=component)
