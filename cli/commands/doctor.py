"""`pico doctor`."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError

from ..hints import with_flags
from ..session import Session
from ..views import doctor as view

HEADING = "The simulator, and the rest"
ORDER = 120

if TYPE_CHECKING:
    from pico.diagnostics import Diagnostic


def doctor(
    context: typer.Context,
    journal: Annotated[
        bool, typer.Option("--journal", help="Show what can be salvaged of a damaged journal, and what would be lost.")
    ] = False,
    yes: Annotated[
        bool, typer.Option("--yes", "-y", help="With --journal: write the new journal; the old one is set aside.")
    ] = False,
) -> int:
    """Check git, its merge driver, the manifests and all that PICO keeps in `.pico`; show versions.

    On a bench with devices it asks these for faults, too.

    Examples:
      pico doctor
      pico doctor --journal
      pico doctor --journal --yes
    """
    from pico.history.git.attributes import checkup
    from pico.history.lab.missing_files import missing_files
    from pico.manifest.folders import check_folder

    session = Session.of(context)
    if journal:
        return _journal(session, yes)
    checked = check_folder(session.folder, beside=missing_files)
    found = (*checkup(session.folder), *checked.diagnostics, *_kept(session.folder), *_faults(session))
    session.tell(found)
    session.show(view, found)
    return ExitCode.ERROR if any(d.severity == "error" for d in found) else ExitCode.DONE


def _journal(session: Session, yes: bool) -> int:
    from pico.bench.mending.journal import salvage_journal
    from pico.manifest.load import find_lab

    from ..views import salvage

    found = salvage_journal(session.here(find_lab(session.folder)), write=yes)
    session.show(salvage, found)
    return ExitCode.CHANGES if found.damaged and not found.written else ExitCode.DONE


def _faults(session: Session) -> tuple[Diagnostic, ...]:
    """Return the faults of the devices of the bench that is meant, and why they can't be asked; those of a simulated
    bench keep none."""
    from pico.backends.devices import EMULATED, HARDWARE
    from pico.bench.bench import Bench
    from pico.manifest.load import find_lab
    from pico.model.instruments.fault import fault_diagnostic
    from pico.places.bench import BenchPlace

    try:
        place = session.place(find_lab(session.folder))
        if not isinstance(place, BenchPlace) or place.name not in (EMULATED, HARDWARE):
            return ()
        with Bench.open(session.folder, backend=session.backend, bench=place) as bench:
            return tuple(fault_diagnostic(fault) for fault in bench.recovery.faults())
    except PicoError as exc:
        return tuple(replace(one, severity="warning") for one in exc.diagnostics)


def _reaching(root: Path, one: Diagnostic) -> Diagnostic:
    """Return what is wrong with a file, with a hint that reaches the bench that the file is of, whichever is chosen."""
    bench = re.search(rf"{re.escape(str(root))}/\.pico/benches/([^/\s]+)/", one.summary)
    return replace(one, hint=with_flags(one.hint, [f"--bench {bench[1]}"])) if bench and one.hint else one


def _kept(folder: Path) -> tuple[Diagnostic, ...]:
    """Return what is wrong with what PICO keeps of the lab around a folder: damaged files, and benches that are gone,
    as Git's own folder knows."""
    from pico.backends.devices import shipped
    from pico.bench.mending.files import damaged_files
    from pico.disk import full_disk
    from pico.manifest.load import find_lab
    from pico.places.bench import BenchPlace
    from pico.places.lost import lost_bench
    from pico.recipes.log import Log

    try:
        root = find_lab(folder)
    except PicoError:  # which is said already
        return ()
    found = tuple(_reaching(root, one) for one in damaged_files(root, Log.read))
    try:
        lost = tuple(one for name in shipped() if (one := lost_bench(BenchPlace(root, name))))
    except PicoError:  # what Git's own folder knows is damaged, and told
        lost = ()
    return (*found, *lost, *full_disk(root))
