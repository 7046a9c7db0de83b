"""`pico pull`."""

from __future__ import annotations

import sys

import typer

from pico.diagnostics import ExitCode, warning

from ..arguments import GitWords
from ..session import Session
from ..terminal.waiting import waiting
from ..views import data as said
from ..views import pulled as view

HEADING = "History"
ORDER = 160

SETTINGS = {"ignore_unknown_options": True}


def pull(context: typer.Context, words: GitWords = None) -> int:
    """Run `git pull`, then get the large data of the runs.

    Git's own options go along. Moves nothing.

    Examples:
      pico pull
      pico pull origin e1
    """
    from pico.history.data.lab import LabData
    from pico.history.repository.remote import pull

    session = Session.of(context)
    session.wire(session.folder)
    data = LabData.discover(session.folder)
    before = data.repository.head().commit
    pull(data.repository, words or (), shown=not session.json and sys.stderr.isatty())
    moved = None
    if data.has_place():
        with waiting("Fetching data") as shown:
            moved = data.pull(shared=lambda share: setattr(shown, "share", share))
    session.show(view, before, data.repository.head().commit, moved)
    absent = moved.lost if moved else data.status().absent
    if session.json:
        return ExitCode.ERROR if moved and moved.diagnostics else ExitCode.DONE
    if absent:
        where = f"in {moved.place}" if moved else "known: `git config pico.data.remote FOLDER` says where copies are"
        session.report([warning("data-missing", f"{said.objects(absent)} of runs not here and not {where}")])
    session.report(moved.diagnostics if moved else ())
    return ExitCode.ERROR if moved and moved.diagnostics else ExitCode.DONE
