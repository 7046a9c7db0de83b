"""`pico catalog`: component types, and the parts of this bench."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import group, pairs
from ..session import Session
from ..terminal.waiting import waiting
from ..views import catalog as view
from ..views import catalog_page as page_view
from ..views import component_type as type_view
from ..views import new_type as new_view
from ..views import parts as parts_view

HEADING = "Manifests"
ORDER = 40

app = group(
    help="List the component types, show or begin one, or list the parts.",
    examples=("pico catalog", "pico catalog show linear_polarizer", "pico catalog new my_lens --from plano_convex"),
    alone=True,
)


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_types(context)


@app.command("list")
def list_types(context: typer.Context) -> None:
    """List the component types; `pico catalog` alone does the same."""
    from pico.manifest.folders import catalog_of

    session = Session.of(context)
    session.show(view, catalog_of(session.folder))


@app.command()
def show(
    context: typer.Context, name: Annotated[str, typer.Argument(metavar="NAME", help="A component type.")]
) -> None:
    """Show a component type: parameters, tunables, primitives, geometry.

    Examples:
      pico catalog show linear_polarizer
    """
    from pico.manifest.folders import component_type

    session = Session.of(context)
    session.show(type_view, component_type(session.folder, name))


@app.command()
def new(
    context: typer.Context,
    name: Annotated[str, typer.Argument(metavar="NAME", help="What the new type is called.")],
    base: Annotated[str, typer.Option("--from", metavar="TYPE", help="The type that it begins as.")],
    given: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PARAMETER=VALUE", help="Another value of a parameter."),
    ] = None,
) -> None:
    """Begin a component type of this lab's own: `types/NAME.yaml`, from one that is there.

    Where only a number is another, a part can say it in `lab.yaml`: `parameters: {focal_length: 80}`.

    Examples:
      pico catalog new my_lens --from plano_convex --set focal_length=80
    """
    from pico.manifest.files import shown_path
    from pico.manifest.new_type import line_of_part, new_type

    session = Session.of(context)
    path = new_type(session.folder, name, base, pairs(given))
    session.show(new_view, shown_path(path), name=name, line=line_of_part(session.folder, name))


@app.command()
def page(
    context: typer.Context,
    out: Annotated[Path, typer.Option("--out", metavar="HTML", help="Where it goes.")] = Path("catalog.html"),
) -> None:
    """Write a page with a drawing of each component type, and all that is to be known of it.

    Examples:
      pico catalog page
      pico catalog page --out docs/catalog.html
    """
    from base64 import b64encode

    from pico.disk import write_whole
    from pico.drawing.picture import png
    from pico.drawing.portrait import portrait
    from pico.manifest.folders import catalog_of

    session = Session.of(context)
    kinds = catalog_of(session.folder)
    pictures = {}
    with waiting("Drawing the types") as progress:
        for number, (name, kind) in enumerate(kinds.items()):
            pictures[name] = f"data:image/png;base64,{b64encode(png(portrait(kind))).decode()}"
            progress.share = (number + 1) / len(kinds)
    html = page_view.page("Component types of PICO", kinds, pictures)
    write_whole(session.folder / out, html.encode())
    session.show(page_view, str(out), types=len(kinds))


@app.command()
def parts(
    context: typer.Context,
    free: Annotated[bool, typer.Option("--free", help="Only those in storage that the manifest does not use.")] = False,
) -> None:
    """List the parts of this bench and where they are.

    Examples:
      pico catalog parts --free
    """
    session = Session.of(context)
    session.show(parts_view, session.bench().measurements.parts(free=free), free=free)
