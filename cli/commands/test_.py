"""`pico test`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError
from pico.disk import write_whole

from ..arguments import Fidelity
from ..session import Session
from ..views import rehearsed as view

HEADING = "Recipes"
ORDER = 30

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
    the lab, its bench and its journal are not touched. Above labs, those of each. Kinematic unless told otherwise. A
    recipe with a parameter that has no default is a function of other recipes: it is checked and not run. Exits with 1
    if one fails.

    Examples:
      pico test
      pico test tilt_scan --junit tests.xml
    """
    session = Session.of(context)
    labs: dict[str, tuple[Rehearsed, ...]] = {}
    for root in _roots(session.folder):
        name, found = _tried(session, root, recipes or (), fidelity or "kinematic", jobs or os.cpu_count() or 2)
        labs[name] = (*labs.get(name, ()), *found)
    if junit:
        write_whole(session.folder / junit, view.junit(labs).encode(), folders=True)
    found = tuple(one for tried in labs.values() for one in tried)
    if session.json:
        session.document(view.data(labs))
    else:
        session.say(view.text(found))
    for one in found:
        session.tell(one.diagnostics)
    return int(ExitCode.DONE if all(one.passed for one in found) else ExitCode.ERROR)


def _roots(folder: Path) -> list[Path]:
    """Return the folder of the lab that one lies in, or of every lab below it; raises PicoError if there is none."""
    from pico.manifest.load import find_lab, labs_below

    try:
        return [find_lab(folder)]
    except PicoError:
        if below := labs_below(folder):
            return below
        raise


def _tried(
    session: Session, root: Path, wanted: Sequence[str], fidelity: str, jobs: int
) -> tuple[str, tuple[Rehearsed, ...]]:  # fmt: skip
    """Return the name of a lab, and how its recipes went."""
    from pico.bench.bench import Bench
    from pico.edge.network.meant import LOCAL
    from pico.recipes.recipes import Recipes
    from pico.recipes.rehearsing import rehearse_all

    with Bench.open(root, bench=LOCAL) as bench:
        lab = Recipes(bench)
        names = [str(lab.path(name).resolve()) if os.sep in name else name for name in wanted or lab.names()]
        for name in names:
            lab.path(name)
        called = bench.setup.lab.name

    def heard(one: Rehearsed) -> None:
        session.say(view.line(one))

    return called, rehearse_all(root, names, fidelity=fidelity, jobs=jobs, heard=heard)
