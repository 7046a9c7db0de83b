"""One operation at a time, 2: `pico move`."""

from __future__ import annotations

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Pairs, Speed, Yes, pairs
from ..runs.approving import single
from ..session import Session

SETTINGS = {"ignore_unknown_options": True}


def move(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Move a component to a pose or a slot.

    `pico move p2 x=500 y=420 yaw=30`; what is not named stays. `pico move p2 500 420 30` is the same.
    `pico move p2 storage/b2` takes it to a slot.
    """
    return single(
        Session.of(context),
        component,
        "move",
        pairs(arguments, ("x", "y", "yaw")),
        speed,
        dry_run,
        fidelity,
        auto_approve,
    )
