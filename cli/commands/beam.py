"""`pico beam`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..session import Session
from ..terminal.waiting import waiting
from ..views import beam as view

HEADING = "The simulator, and the rest"
ORDER = 20


def beam(
    context: typer.Context,
    revision: Annotated[
        str | None, typer.Argument(metavar="REV", help="A commit, branch or tag; without it the bench as it is.")
    ] = None,
    manifest: Annotated[bool, typer.Option("--manifest", help="As the manifest wants it.")] = False,
    source: Annotated[str | None, typer.Option("--source", metavar="COMPONENT", help="Of this laser alone.")] = None,
    picture: Annotated[Path | None, typer.Option("--picture", metavar="PNG", help="Draw it from above.")] = None,
) -> None:
    """Show where beams run, and what they are like.

    A row for each component that a beam comes to: how far from the source, its 1/e2 radius, power and polarization
    there, and how much its edge stops. Warns of what is missed, clipped, sent back into a laser or saturated. Nothing
    is measured: it is computed from where things stand and how they are set. A laser that is off is followed as if it
    shone.

    Examples:
      pico beam
      pico beam e1 --picture e1.png
    """
    from pico.diagnostics import PicoError, error

    session = Session.of(context)
    if revision and manifest:
        hint = "leave one of them out"
        raise PicoError(error("usage", "--manifest is about the manifest, not a revision", hint=hint))
    bench = session.bench()
    with waiting("Following the light"):
        found = bench.light.beams(revision, manifest=manifest, source=source)
    session.show(view, found)
    session.tell(found.diagnostics)
    session.draw(picture, found.goal, lambda path: bench.light.picture(
        revision, manifest=manifest, source=source, out=path
    ))  # fmt: skip
