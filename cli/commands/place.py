"""One operation at a time, 4: `pico place`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Speed, Yes
from ..runs.approving import finish
from ..session import Session


def place(
    context: typer.Context,
    component: Component,
    after: Annotated[str, typer.Option("--after", metavar="OTHER", help="The component that it follows.")],
    distance: Annotated[float, typer.Option("--distance", metavar="MM", help="Between the optical planes.")],
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Place a component a distance after another along the beam."""
    session = Session.of(context)
    bench = session.bench(fidelity, speed, writing=not dry_run)
    return finish(session, bench, bench.plans.place(component, after=after, distance=distance), dry_run, auto_approve)
