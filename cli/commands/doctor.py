"""`pico doctor`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pico.diagnostics import ExitCode, PicoError

from ..session import Session
from ..views import doctor as view

HEADING = "The simulator, and the rest"
ORDER = 120

if TYPE_CHECKING:
    from pico.diagnostics import Diagnostic


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
    found = (*checkup(session.folder), *checked.diagnostics, *_lost(session.folder))
    session.tell(found)
    session.show(view, found)
    return ExitCode.ERROR if any(d.severity == "error" for d in found) else ExitCode.DONE


def _lost(folder: Path) -> tuple[Diagnostic, ...]:
    """Return which benches of the lab around a folder are gone, as Git's own folder knows."""
    from pico.backends.devices import shipped
    from pico.manifest.load import find_lab
    from pico.places.bench import BenchPlace
    from pico.places.lost import lost_bench

    try:
        root = find_lab(folder)
    except PicoError:  # which is said already
        return ()
    return tuple(found for name in shipped() if (found := lost_bench(BenchPlace(root, name))))
