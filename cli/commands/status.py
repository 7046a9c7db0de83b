"""`pico status`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import PicoError

from ..session import Session
from ..views import status as view

if TYPE_CHECKING:
    from pico.diagnostics import Diagnostic

HEADING = "The main job"
ORDER = 20


def status(
    context: typer.Context,
    every: Annotated[bool, typer.Option("--all", help="Show equal rows of a large bench, too.")] = False,
) -> None:
    """Show what is committed, desired and live, side by side.

    `*` marks what the manifest changes against the last commit, `!` what stands elsewhere than the manifest says.

    Examples:
      pico status
      pico status --all
    """
    from pico.history.merge.doubts import unsettled

    session = Session.of(context)
    try:
        bench = session.bench()
        session.tell(tuple(unsettled(bench.folder.repository, bench.root, bench.folder.manifests)))
        found = bench.drift.status()
    except PicoError as exc:  # of manifests, or of a journal; what emits meanwhile is reported all the same
        raise PicoError([*exc.diagnostics, *_light(session)], exc.exit_code) from exc
    session.tell((*found.cut_short, *found.lacking))
    session.show(view, found, every=every)


def _light(session: Session) -> tuple[Diagnostic, ...]:
    """Return which lasers of the bench emit, and how an unattended run left it, by the Lab that the bench keeps."""
    from pico.bench.bench import Bench
    from pico.bench.lasers import light

    try:
        place = session.place(session.root(safety=True))
        with Bench.open(session.folder, backend=session.backend, bench=place, safety="light") as bench:
            return light(bench)
    except PicoError:  # the bench cannot be opened at all, which the caller reports
        return ()
