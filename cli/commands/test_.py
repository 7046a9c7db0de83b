"""Recipes, 3: `pico test`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode
from pico.disk import write_whole

from ..arguments import Fidelity
from ..session import Session
from ..views import rehearsed as view

if TYPE_CHECKING:
    from pico.recipes.rehearsing import Rehearsed


def test_(
    context: typer.Context,
    recipes: Annotated[
        list[str] | None, typer.Argument(metavar="[RECIPE]...", help="These alone; without, all of the lab.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option("--jobs", "-j", metavar="N", min=1, help="At a time; without, one for each core.")
    ] = None,
    junit: Annotated[Path | None, typer.Option("--junit", metavar="FILE", help="Write JUnit XML to FILE.")] = None,
    fidelity: Fidelity = None,
) -> int:
    """Try the recipes of the lab in the simulator, as CI does.

    Each runs with its default parameters in a clone of the repository and on a bench of its own, several side by side:
    the lab, its bench and its journal are not touched. Kinematic unless told otherwise. Exits with 1 where one fails.

    Examples:
      pico test
      pico test tilt_scan --junit tests.xml
    """
    from pico.recipes.recipes import Recipes
    from pico.recipes.rehearsing import rehearse_all

    session = Session.of(context)
    lab = Recipes(session.bench())
    names = [str(lab.path(name).resolve()) if os.sep in name else name for name in recipes or lab.names()]
    for name in names:
        lab.path(name)

    def heard(one: Rehearsed) -> None:
        session.say(view.line(one))

    found = rehearse_all(
        lab.bench.root, names, fidelity=fidelity or "kinematic", jobs=jobs or os.cpu_count() or 2,
        heard=heard,
    )  # fmt: skip
    if junit:
        write_whole(session.folder / junit, view.junit(found, lab.bench.setup.lab.name).encode())
    if session.json:
        session.document(view.data(found))
    else:
        session.say(view.text(found))
    for one in found:
        session.tell(one.diagnostics)
    return int(ExitCode.DONE if all(one.passed for one in found) else ExitCode.ERROR)
