"""`pico recipe`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode

from ..arguments import group
from ..session import Session
from ..terminal.waiting import waiting
from ..views import recipe as view
from ..views import recipe_list as table
from ..views import recipe_steps as steps_view
from ..views import recipe_written as written

HEADING = "Recipes"
ORDER = 20

app = group(
    help="List and check recipes: experiments that anybody can run again.",
    examples=("pico recipe", "pico recipe check tilt_scan", "pico recipe steps"),
    alone=True,
)


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_(context)


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the recipes of the lab, and runs of recipes that were cut short; `pico recipe` alone does the same.

    Examples:
      pico recipe list
    """
    from pico.recipes.recipes import Recipes

    session = Session.of(context)
    recipes = Recipes(session.bench())
    session.show(table, recipes.listed(), recipes.cut_short())
    session.tell(recipes.broken)


@app.command()
def check(
    context: typer.Context,
    recipe: Annotated[str, typer.Argument(metavar="RECIPE", help="A file, or a name in `recipes/`.")],
    given: Annotated[
        list[str] | None, typer.Option("-p", "--param", metavar="NAME=VALUE", help="A parameter; may be repeated.")
    ] = None,
) -> int:
    """Check a recipe on this bench before anything moves.

    Names, kinds, units, what the bench can do; then every state that is known in advance is planned from the one
    before it. What depends on a measurement is listed, and left out of that. Exits with 1 for mistakes, 3 for what is
    physically impossible.

    Examples:
      pico recipe check tilt_scan -p tilts='[0, 45]'
    """
    from pico.recipes.recipes import Recipes

    from .run import _pairs

    session = Session.of(context)
    recipes = Recipes(session.bench())
    found, wrong = recipes.check(recipe)
    if wrong or found is None:
        session.report(wrong)
        return int(ExitCode.ERROR)
    session.tell(found.told)
    with waiting("Planning what is known in advance"):
        ahead = recipes.ahead(found, recipes.arguments(found, _pairs(given or [])))
    session.show(view, found, ahead)
    session.report(ahead.diagnostics)
    return int(ahead.exit_code)


@app.command()
def steps(context: typer.Context) -> None:
    """List the steps that recipes may have, each with an example, and the functions of expressions.

    Examples:
      pico recipe steps
    """
    from pico.recipes.registry import INTERFACE
    from pico.registered import intact

    session = Session.of(context)
    found, broken = intact(INTERFACE)
    session.show(steps_view, {name: file.KIND for name, file in found.items()})
    session.tell(broken)


@app.command("from")
def from_(
    context: typer.Context,
    runs: Annotated[list[str], typer.Argument(metavar="RUN...", help="Runs by id, in the order of their steps.")],
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Where it is written.")] = None,
) -> int:
    """Write a recipe of what was done: by hand, from Python, by sight or by steering.

    Each thing that was done in the runs becomes a step; what was steered by eye is set to where that ended. Parameters,
    loops and names of results are yours to add. Without -o it is printed.

    Examples:
      pico recipe from 20260105T0900 -o recipes/warm_up.yaml
    """
    from pico.diagnostics import PicoError, error
    from pico.disk import write_whole
    from pico.recipes.encoding import encoded

    session = Session.of(context)
    bench = session.bench()
    name = out.stem if out else "from_runs"
    text = encoded(name, bench.setup.lab.name, [bench.history.recorded_run(run)[0] for run in runs])
    if out is None:
        session.show(written, text)
        return 0
    path = session.folder / out
    if path.exists():
        raise PicoError(error("exists", f"{out} is there already", hint="name another file, or take it away first"))
    write_whole(path, text.encode(), folders=True)
    session.show(written, text, out)
    return 0
