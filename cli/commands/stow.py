"""One operation at a time, 5: `pico stow`."""

from __future__ import annotations

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Speed, Yes
from ..runs.approving import single
from ..session import Session


def stow(
    context: typer.Context,
    component: Component,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Put a component back into its home slot."""
    return single(Session.of(context), component, "stow", {}, speed, dry_run, fidelity, auto_approve)
