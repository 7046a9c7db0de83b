"""`pico get`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import values as view

HEADING = "One operation at a time"
ORDER = 50


def get(
    context: typer.Context,
    what: Annotated[list[str], typer.Argument(metavar="COMPONENT[.TUNABLE]...", help="Or COMPONENT.MEASURABLE.")],
) -> None:
    """Read tunables, or all of a component.

    Pose included, as they are on the bench. A measurable is peeked at: nothing is opened for it, and nothing of it is
    assured, which `pico do COMPONENT measure` does.

    Examples:
      pico get p1
      pico get p1.angle p2.angle
      pico get left.frame
    """
    session = Session.of(context)
    bench = session.bench()
    for one in what:
        component, _, tunable = one.partition(".")
        session.show(view, bench.measurements.read(component, tunable or None), component=component)
