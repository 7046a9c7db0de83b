"""Manifests, 4: `pico catalog list` and `pico catalog show NAME`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..session import Session
from ..views import catalog as view
from ..views import component_type as type_view

app = typer.Typer(rich_markup_mode=None, no_args_is_help=True, help="List the component types, or show one.")


@app.command("list")
def list_types(context: typer.Context) -> None:
    """List the component types."""
    from pico.manifest.folders import catalog_of

    session = Session.of(context)
    session.show(view, catalog_of(session.folder))


@app.command()
def show(
    context: typer.Context, name: Annotated[str, typer.Argument(metavar="NAME", help="A component type.")]
) -> None:
    """Show a component type: parameters, tunables, measurables, primitives, geometry."""
    from pico.manifest.folders import component_type

    session = Session.of(context)
    session.show(type_view, component_type(session.folder, name))
