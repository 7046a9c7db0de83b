"""`pico set`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import DryRun, Fidelity, LockTimeout, Manifest, Yes, value_of
from ..runs.approving import single, written
from ..session import Session

HEADING = "One operation at a time"
ORDER = 40

Values = Annotated[
    list[str] | None, typer.Argument(metavar="VALUE|TUNABLE=VALUE...", help="To what; TUNABLE+=STEP from where it is.")
]
SETTINGS = {"ignore_unknown_options": True}


def set_(
    context: typer.Context,
    component: Annotated[str, typer.Argument(metavar="COMPONENT[.TUNABLE]", help="What is to be set.")],
    arguments: Values = None,
    dry_run: DryRun = False,
    manifest: Manifest = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Set tunables of a component.

    `+=` and `-=` step from the present value, with --manifest from that in the manifest. An angle that repeats may be
    written beyond its range: 400 deg is 40.

    Examples:
      pico set p1.angle 3
      pico set m1 tip=3 tilt=-1
      pico set p1 angle+=5
      pico set cam exposure="2 ms"
      pico set p1 angle=3 --manifest
    """
    name, given = value_of(component, arguments or [])
    if manifest:
        return written(Session.of(context), name, "set", given, dry_run)
    return single(Session.of(context), name, "set", given, None, dry_run, fidelity, auto_approve)
