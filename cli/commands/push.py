"""`pico push`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import PicoError, error, warning

from ..arguments import GitWords
from ..session import Session
from ..terminal.waiting import waiting
from ..views import data as said
from ..views import pushed as view

HEADING = "History"
ORDER = 150

if TYPE_CHECKING:
    from pico.history.data.lab import LabData
    from pico.history.data.transfer import Moved

SETTINGS = {"ignore_unknown_options": True}


def push(
    context: typer.Context,
    words: GitWords = None,
    no_data: Annotated[
        bool, typer.Option("--no-data", help="Send commits only; the data of their runs stays.")
    ] = False,
) -> None:
    """Send the large data of runs to its place, then `git push`.

    Git's own options go along. Nothing is pushed where data would stay behind, unless --no-data says so.

    Examples:
      pico push
      pico push origin e1
    """
    from pico.history.data.lab import LabData
    from pico.history.repository.remote import push

    session = Session.of(context)
    data = LabData.discover(session.folder)
    moved = None if no_data else _send(session, data)
    if moved and moved.diagnostics:
        hint = "`pico data fsck` says more; `pico push --no-data` sends the commits all the same"
        text = "the commits were not sent, for data of their runs can't be"
        raise PicoError((*moved.diagnostics, error("data-unsent", text, hint=hint)))
    sent = push(data.repository, words or (), shown=not session.json and sys.stderr.isatty())
    session.show(view, sent, moved)


def _send(session: Session, data: LabData) -> Moved | None:
    """Send the data, and return what became of it; None where no place is known, and nothing here would be left."""
    if data.has_place():
        with waiting("Sending data") as shown:
            moved = data.push(shared=lambda share: setattr(shown, "share", share))
        if moved.lost and not session.json:
            text = f"{said.objects(moved.lost)} that runs need neither here nor in {moved.place}"
            session.report([warning("data-missing", text, hint="`pico data status` names them")])
        return moved
    left = data.status().unsent
    if left:
        text = f"{said.objects(left)} of runs would stay here: nothing says where the data of this lab is kept"
        hint = "`git config pico.data.remote FOLDER` says it, `pico push --no-data` sends the commits all the same"
        raise PicoError(error("data-place", text, hint=hint))
    return None
