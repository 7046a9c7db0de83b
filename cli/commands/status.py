"""`pico status`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import status as view

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
    bench = session.bench()
    session.tell(tuple(unsettled(bench.folder.repository, bench.root, bench.folder.manifests)))
    found = bench.drift.status()
    session.tell(found.cut_short)
    session.show(view, found, every=every)
