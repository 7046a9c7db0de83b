"""The simulator, and the rest, 11: `pico doctor`."""

from __future__ import annotations

import typer

from pico.diagnostics import ExitCode

from ..session import Session
from ..views import doctor as view


def doctor(context: typer.Context) -> int:
    """Check git, its merge driver and the manifests; show versions.

    Examples:
      pico doctor
    """
    from pico.history.git.attributes import checkup
    from pico.history.lab.missing_files import missing_files
    from pico.manifest.folders import check_folder

    session = Session.of(context)
    checked = check_folder(session.folder, beside=missing_files)
    found = (*checkup(session.folder), *checked.diagnostics)
    session.tell(found)
    session.show(view, found)
    return ExitCode.ERROR if any(d.severity == "error" for d in found) else ExitCode.DONE
