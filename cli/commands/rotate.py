"""One operation at a time, 3: `pico rotate`."""

from __future__ import annotations

import typer

from pico.diagnostics import PicoError, error

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Pairs, Speed, Yes, pairs
from ..runs.approving import single
from ..session import Session

SETTINGS = {"ignore_unknown_options": True}


def rotate(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Turn a component about the vertical.

    Degrees: `pico rotate p2 30` turns it to yaw 30, `pico rotate p2 by=-5` from where it stands.
    """
    given = pairs(arguments, ("yaw",))
    if not given.keys() <= {"yaw", "by"} or len(given) != 1:
        raise PicoError(error("usage", "rotate takes one of `yaw=DEGREES` and `by=DEGREES`"))
    return single(Session.of(context), component, "move", given, speed, dry_run, fidelity, auto_approve)
