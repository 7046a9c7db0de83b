"""One operation at a time, 8: `pico home`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Yes
from ..runs.approving import single
from ..session import Session


def home(
    context: typer.Context,
    component: Component,
    tunable: Annotated[str | None, typer.Argument(metavar="TUNABLE", help="Needed where there are several.")] = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Home the axis of a tunable."""
    return single(
        Session.of(context),
        component,
        "home",
        {"tunable": tunable} if tunable else {},
        None,
        dry_run,
        fidelity,
        auto_approve,
    )
