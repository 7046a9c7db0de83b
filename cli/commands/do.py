"""`pico do`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Manifest, Pairs, Speed, Yes, pairs
from ..runs.approving import single, written
from ..session import Session

HEADING = "One operation at a time"
ORDER = 10

SETTINGS = {"ignore_unknown_options": True}


def do(
    context: typer.Context,
    component: Component,
    primitive: Annotated[
        str, typer.Argument(metavar="PRIMITIVE", help="move, stow, set, home, scan, measure, auto_range.")
    ],
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    manifest: Manifest = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Run one primitive of a component, checked as a plan is.

    The manifest stays as it is: `pico capture` takes the result into it. With --manifest a move, a stow or a set
    changes it alone, and counts from what it says.

    Examples:
      pico do p2 move x=500 y=420 yaw=30
      pico do p1 home angle
      pico do cam auto_range
      pico do p2 measure pose
    """
    from pico.model.primitive import primitive as known

    given = pairs(arguments, tuple(known(primitive).arguments))
    if manifest:
        return written(Session.of(context), component, primitive, given, dry_run)
    return single(Session.of(context), component, primitive, given, speed, dry_run, fidelity, auto_approve)
