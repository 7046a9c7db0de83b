"""`pico ruler`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..session import Session
from ..views import ruler as view

HEADING = "The simulator, and the rest"
ORDER = 40

A = Annotated[
    str,
    typer.Argument(metavar="COMPONENT|SLOT|X,Y", help="COMPONENT[:optical|base|hole], SLOT, hole:COLUMN,ROW or X,Y."),
]
B = Annotated[str, typer.Argument(metavar="COMPONENT|SLOT|X,Y", help="As A.")]
Picture = Annotated[Path | None, typer.Option("--picture", metavar="PNG", help="Draw it from above.")]


Along = Annotated[bool, typer.Option("--along-beam", help="Only the way of the light, through all that bends it.")]


def ruler(context: typer.Context, a: A, b: B, along_beam: Along = False, picture: Picture = None) -> None:
    """Measure between two things on the bench.

    Between their points, between their nearest faces, and along the beam axis of the first one. Holes are counted from
    1,1 at the front left.

    Examples:
      pico ruler lx_125 ly_150
      pico ruler p2:base hole:12,7
      pico ruler laser cam --along-beam
      pico ruler cam 520,420
    """
    session = Session.of(context)
    bench = session.bench()
    found = bench.pictures.ruler(a, b)
    if along_beam and not found.ways:
        text = f"no beam goes between {found.a.name} and {found.b.name}"
        raise PicoError(error("no-beam", text, hint="`pico beam` shows where the beams go"))
    session.show(view, found, along_beam=along_beam)
    session.draw(picture, "it", lambda path: bench.pictures.render_ruler(found, out=path))
