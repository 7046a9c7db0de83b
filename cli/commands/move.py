"""`pico move`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import Component, DryRun, Fidelity, LockTimeout, Manifest, Speed, Yes, pairs
from ..runs.approving import single, written
from ..session import Session

HEADING = "One operation at a time"
ORDER = 20

Where = Annotated[
    list[str] | None,
    typer.Argument(metavar="SLOT|home|KEY=VALUE...", help="x, y, yaw (or bare, in turn), turn, after, distance."),
]
SETTINGS = {"ignore_unknown_options": True}


def move(
    context: typer.Context, component: Component, arguments: Where = None, speed: Speed = None, dry_run: DryRun = False,
    manifest: Manifest = False, fidelity: Fidelity = None, auto_approve: Yes = False, lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Move a component: to a pose, by an angle, to a slot, home.

    What is not named of x, y and yaw stays; `turn`, `x+=` and `y-=` count from where it stands, `distance` from the
    optical plane of the other one, the way that one faces. The manifest stays as it is; with --manifest it alone
    changes: what is not named stays as it is there, and steps count from there.

    Examples:
      pico move p2 x=500 y=420 yaw=30
      pico move p2 x+=10 turn=-5
      pico move p2 storage/b2
      pico move p2 home
      pico move ly_150 after=p2 distance=150
    """
    given = pairs(arguments, ("x", "y", "yaw"))
    if manifest:
        return written(Session.of(context), component, "move", given, dry_run)
    return single(Session.of(context), component, "move", given, speed, dry_run, fidelity, auto_approve)
