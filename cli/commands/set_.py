"""One operation at a time, 6: `pico set`."""

from __future__ import annotations

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Pairs, Yes, pairs
from ..runs.approving import single
from ..session import Session

SETTINGS = {"ignore_unknown_options": True}


def set_(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Set a tunable.

    Examples:
      pico set p1 angle=3
      pico set cam exposure="2 ms"
    """
    return single(Session.of(context), component, "set", pairs(arguments), None, dry_run, fidelity, auto_approve)
