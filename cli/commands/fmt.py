"""`pico fmt`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..session import Session
from ..views import formatted as view

HEADING = "Manifests"
ORDER = 20


def fmt(
    context: typer.Context,
    files: Annotated[list[Path] | None, typer.Argument(metavar="FILE...", help="Without: all of the lab.")] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit with 1 where a file would change.")
    ] = False,
) -> int:
    """Bring manifests into the normal form; comments stay.

    Examples:
      pico fmt
      pico fmt --check state/table.yaml
    """
    from pico.manifest.folders import format_folder

    session = Session.of(context)
    changed = format_folder(session.folder, [session.folder / f for f in files or []], write=not check)
    session.show(view, changed, check=check)
    return ExitCode.ERROR if check and changed else ExitCode.DONE
