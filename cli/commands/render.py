"""`pico render`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from pico.diagnostics import PicoError, error
from pico.disk import write_whole

from ..session import Session
from ..terminal.waiting import waiting
from ..views import picture as view

HEADING = "The simulator, and the rest"
ORDER = 30

if TYPE_CHECKING:
    from pico.bench.bench import Bench

LARGEST = 8000
"""Pixels along an edge."""


def render(
    context: typer.Context,
    revision: Annotated[
        str | None, typer.Argument(metavar="REV", help="A commit, branch or tag; without it the bench as it is.")
    ] = None,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="Where it goes: .png, or .svg for a drawing with parts list.")
    ] = Path("bench.png"),
    looking: Annotated[
        Literal["perspective", "top"], typer.Option("--view", metavar="perspective|top", help="From where.")
    ] = "perspective",
    manifest: Annotated[bool, typer.Option("--manifest", help="As the manifest wants it.")] = False,
    plan: Annotated[
        bool, typer.Option("--plan", help="Show what would move on the way to REV or the manifest.")
    ] = False,
    size: Annotated[
        str, typer.Option("--size", metavar="W[xH]", help="Pixels; without H as high as the table.")
    ] = "960",
) -> None:
    """Draw the bench: a PNG, or as SVG with its parts list.

    As it is, with --manifest as the manifest wants it, or as REV wants it. Needs no OpenGL. An SVG is drawn from above
    at true scale, one unit a millimetre, with names and a parts list.

    Examples:
      pico render e1 --out e1.png
      pico render --view top --plan
    """
    session = Session.of(context)
    _require(looking, out, plan, manifest and revision is not None)
    pixels = _pixels(size)
    bench = session.bench()
    path = session.folder / out
    with waiting("Drawing"):
        if out.suffix.lower() == ".svg":
            write_whole(path, bench.pictures.sheet(revision, manifest=manifest).encode())
        else:
            bench.pictures.render(revision, manifest=manifest, view=looking, plan=plan, size=pixels, out=path)
    session.show(view, path, shown=out, what=_what(bench, revision, manifest, plan))


def _what(bench: Bench, revision: str | None, manifest: bool, plan: bool) -> str:
    goal = bench.history.name_of(revision) if revision else "the manifest"
    if plan:
        return f"the bench as it is, and dashed where parts go for {goal}"
    return goal if revision or manifest else "the bench as it is"


def _require(looking: str, out: Path, plan: bool, both: bool) -> None:
    if out.suffix.lower() not in (".png", ".svg"):
        hint = f"`--out {out.stem or 'bench'}.png` or `--out {out.stem or 'bench'}.svg`"
        raise PicoError(error("usage", f"{out} is neither a .png nor a .svg", hint=hint))
    if both:
        raise PicoError(error("usage", "--manifest draws the manifest, not a revision", hint="leave one of them out"))
    if plan and out.suffix.lower() == ".svg":
        hint = "`pico plan --picture plan.png` draws it as PNG"
        raise PicoError(error("usage", "an SVG shows no plan", hint=hint))
    if plan and looking != "top":
        raise PicoError(error("usage", "what would move is drawn from above only", hint="add `--view top`"))


def _pixels(size: str) -> tuple[int, int | None]:
    """Return width and height of `960x720`; without a height that is None."""
    found = re.fullmatch(r"(\d+)(?:x(\d+))?", size)
    width, height = (int(found[1]), int(found[2]) if found[2] else None) if found else (0, None)
    if not (64 <= width <= LARGEST and (height is None or 48 <= height <= LARGEST)):
        hint = (
            f"width, or width x height, in pixels, for example 1920x1440; at least 64x48, at most {LARGEST}x{LARGEST}"
        )
        raise PicoError(error("usage", f"`{size}` is no size of a picture", hint=hint))
    return width, height
