"""`pico data`: the large data of runs, here and where copies are kept."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Yes, group
from ..session import Session
from ..terminal.waiting import waiting
from ..views import data as view

HEADING = "The simulator, and the rest"
ORDER = 90

if TYPE_CHECKING:
    from pico.history.data.lab import LabData
    from pico.history.data.transfer import Moved, Shared

app = group(
    help="The large data of runs: where it is, to there and from there.",
    examples=("pico data status", "pico data push /mnt/share", "pico data gc --dry-run"),
)
_UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
Place = Annotated[
    str | None,
    typer.Argument(
        metavar="FOLDER|URL|lfs", help="Where copies are; without it what `git config pico.data.remote` says."
    ),
]


@app.command()
def status(context: typer.Context, place: Place = None) -> None:
    """Show which data the runs need, and what of it is here and there.

    Examples:
      pico data status
    """
    session = Session.of(context)
    with waiting("Looking"):
        found = _data(session).status(_at(session, place))
    session.show(view, found)


@app.command()
def push(context: typer.Context, place: Place = None) -> int:
    """Copy what is here and not there; a second time only what lacks.

    Examples:
      pico data push /mnt/share
    """
    session = Session.of(context)
    data = _data(session)
    return _move(session, "Sending", "sent", lambda shared: data.push(_at(session, place), shared))


@app.command()
def pull(context: typer.Context, place: Place = None) -> int:
    """Copy what the runs need and is not here.

    Examples:
      pico data pull
    """
    session = Session.of(context)
    data = _data(session)
    return _move(session, "Fetching", "fetched", lambda shared: data.pull(_at(session, place), shared))


@app.command()
def fsck(context: typer.Context) -> int:
    """Read every object again.

    Damaged ones are set aside; those and missing ones are named with their runs.

    Examples:
      pico data fsck
    """
    session = Session.of(context)
    with waiting("Reading") as shown:
        found = _data(session).check(lambda share: setattr(shown, "share", share))
    session.show(view, found)
    return ExitCode.DONE if found.well else ExitCode.ERROR


@app.command()
def gc(
    context: typer.Context,
    grace: Annotated[
        str, typer.Option("--grace", metavar="TIME", help="Keep what is younger than this: 14d, 6h, 0d.")
    ] = "14d",
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say what would go, and remove nothing.")] = False,
    yes: Yes = False,
) -> None:
    """Remove old objects that nothing here needs.

    That is: no run of any ref, reflog, index, working tree or journal.

    Examples:
      pico data gc --grace 6h --dry-run
    """
    session = Session.of(context)
    data, seconds = _data(session), _seconds(grace)
    with waiting("Looking"):
        found = data.garbage(seconds)
    if asked := bool(found.removable) and not (dry_run or yes):
        session.require_answer(yes)
        session.say(view.text(found))
    if asked and not session.confirm(f"Remove them, {view.size(found.size)}?", yes):
        raise PicoError(error("declined", "nothing was removed", hint="`--auto-approve` does not ask"))
    freed = None if dry_run else data.remove(found, seconds)
    session.show(view, found, freed=freed)


@app.command()
def pointers(
    context: typer.Context,
    runs: Annotated[list[str] | None, typer.Argument(metavar="[RUN]...", help="Without: all in the files.")] = None,
) -> None:
    """Write Git LFS pointers for the data of runs beside them.

    For you to commit; git-lfs is handed the data.

    Examples:
      pico data pointers
    """
    from pico.manifest.load import find_lab

    session = Session.of(context)
    found = _data(session).point(find_lab(session.folder), runs or ())
    session.show(view, found)


def _data(session: Session) -> LabData:
    from pico.history.data.lab import LabData

    return LabData.discover(session.folder)


def _at(session: Session, place: str | None) -> str | None:
    """Return a folder as seen from where the command was called."""
    return place if place in (None, "lfs") or "://" in str(place) else str((session.folder / place).absolute())


def _move(session: Session, doing: str, done: str, move: Callable[[Shared], Moved]) -> int:
    with waiting(doing) as shown:
        found = move(lambda share: setattr(shown, "share", share))
    session.show(view, found, done=done)
    session.tell(found.diagnostics)
    failed = found.diagnostics or (done == "fetched" and found.lost)
    return ExitCode.ERROR if failed else ExitCode.DONE


def _seconds(text: str) -> float:
    match = re.fullmatch(r"(\d+(?:\.\d+)?)(s|min|h|d)", text)
    if not match:
        raise PicoError(error("usage", f"`{text[:40]}` is no time", hint="write it as 14d, 6h, 30min or 0d"))
    return float(match[1]) * _UNITS[match[2]]
