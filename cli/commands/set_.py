"""One operation at a time, 6: `pico set`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..arguments import DryRun, Fidelity, LockTimeout, Manifest, Yes, value_of
from ..runs.approving import single, written
from ..session import Session

Values = Annotated[list[str] | None, typer.Argument(metavar="VALUE|TUNABLE=VALUE", help="To what.")]
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
    """Set a tunable.

    Examples:
      pico set p1.angle 3
      pico set p1 angle=3
      pico set cam exposure="2 ms"
      pico set p1 angle=3 --manifest
    """
    name, given = value_of(component, arguments or [])
    if manifest:
        return written(Session.of(context), name, "set", given, tuple(given), dry_run)
    return single(Session.of(context), name, "set", given, None, dry_run, fidelity, auto_approve)
