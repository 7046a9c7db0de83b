"""The simulator, and the rest, 10: `pico git install`, `pico git uninstall` and `pico git attach`."""

from __future__ import annotations

import typer

from ..arguments import group
from ..session import Session
from ..views import attached
from ..views import wired as view

app = group(
    help="Let git merge manifests by PICO, or not; attach a worktree.", examples=("pico git install", "pico git attach")
)


@app.command()
def install(context: typer.Context) -> None:
    """Tell git about PICO's merge driver, in this repository only.

    The first command that writes does it by itself.

    Examples:
      pico git install
    """
    from pico.history.git.attributes import install

    session = Session.of(context)
    install(session.folder)
    session.show(view, installed=True)


@app.command()
def attach(context: typer.Context) -> None:
    """Attach this worktree to the bench.

    It takes it from the worktree that has it; that one then only plans. A repository's first worktree that moves
    something is attached by itself.

    Examples:
      pico git attach
    """
    from pico.edge.lease import attach

    session = Session.of(context)
    root = session.history().folder.root
    session.show(attached, root, attach(root))


@app.command()
def uninstall(context: typer.Context) -> None:
    """Take PICO's merge driver out of this repository's configuration.

    It is then not set again by itself.

    Examples:
      pico git uninstall
    """
    from pico.history.git.attributes import uninstall

    session = Session.of(context)
    uninstall(session.folder)
    session.show(view, installed=False)
