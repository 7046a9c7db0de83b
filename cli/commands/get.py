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
    tunable: Annotated[str | None, typer.Argument(metavar="TUNABLE", help="Or a measurable; without it, all.")] = None,
) -> None:
    """Read the tunables of a component.

    Pose included, as they are on the bench. A measurable is peeked at: nothing is opened for it, and nothing of it is
    assured, which `pico do COMPONENT measure` does.
    """
    session = Session.of(context)
    session.show(view, session.bench().measurements.read(component, tunable), component=component)
