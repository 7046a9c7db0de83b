"""`pico budget`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..terminal.waiting import waiting
from ..views import budget as view

HEADING = "The simulator, and the rest"
ORDER = 60

What = Annotated[
    str | None, typer.Argument(metavar="[CLAIM|EXPRESSION]", help="A claim of the lab, or of what: `cam.centroid.y`.")
]
Rev = Annotated[str | None, typer.Argument(metavar="[REV]", help="A commit, branch or tag; without it the manifest.")]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="[LOOK.]PART.TUNABLE=VALUE", help="Suppose it so; with LOOK in that setting alone."),
]
For = Annotated[str | None, typer.Option("--for", metavar="2 %|SIZE", help="To what the tolerances must be for that.")]


def budget(
    context: typer.Context, what: What = None, revision: Rev = None, settings: Settings = None, wanted: For = None,
    repeats: Annotated[bool, typer.Option("--repeats", help="As the bench repeats, not as it is tolerated.")] = False,
) -> None:  # fmt: skip
    """Show which tolerance limits a result.

    What each error of placement and of a set-point within its tolerance does to it, by the model of the light; nothing
    is measured, and goals align nothing away. The expression may be over several settings, by name: give each with
    --set. Alone it lists the claims of the lab.

    Examples:
      pico budget cam.centroid.y e1
      pico budget "(a.cam.centroid.y - b.cam.centroid.y) / 2" e1 \\
          --set a.p1.angle=1 --set b.p1.angle=179 --for "2 %"
    """
    from pico.diagnosis.claims import settings_of
    from pico.diagnostics import PicoError, error

    session = Session.of(context)
    bench = session.bench()
    if what is None and (wanted or settings):
        raise PicoError(
            error("usage", "of what result?", hint="a claim of the lab, or an expression: `cam.centroid.y`")
        )
    looks, at = settings_of(bench.setup, settings or ())
    with waiting("Following the light"):
        if what is None:
            told = bench.light.claims(revision)
        else:
            told = (bench.light.budget(what, revision, to=wanted, looks=looks, at=at),)
    session.show(view, told, goal=revision or "the manifest", whole=what is not None, repeats=repeats)
