"""`pico git install`, `uninstall`, `attach`, and git's own `branch` and `tag`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import group
from ..session import Session
from ..views import attached, named
from ..views import wired as view

HEADING = "The simulator, and the rest"
ORDER = 100

Name = Annotated[str, typer.Argument(metavar="NAME", help="What it is to be called.")]
At = Annotated[str, typer.Argument(metavar="REV", help="Where; HEAD where nothing is said.")]

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
    place = session.here(session.history().folder.root)
    session.show(attached, place, attach(place))


@app.command()
def branch(context: typer.Context, name: Name, revision: At = "HEAD") -> None:
    """Begin a branch at a revision, as `git branch` does.

    Nothing is checked out: `pico checkout NAME` goes there. For who has PICO alone, as at a desk of a coordinator.

    Examples:
      pico git branch tilted e1
    """
    _name(context, "branch", name, revision)


@app.command()
def tag(context: typer.Context, name: Name, revision: At = "HEAD") -> None:
    """Give a revision a name that stays, as `git tag` does.

    Examples:
      pico git tag E1-4
    """
    _name(context, "tag", name, revision)


def _name(context: typer.Context, what: str, name: str, revision: str) -> None:
    from pico.history.git.command import run

    session = Session.of(context)
    root = session.history().folder.root
    asked = ["rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}"]
    commit = run(root, asked, doing=f"find {revision}", ends=(0, 1)).strip()
    if not commit:
        raise PicoError(error("revision", f"`{revision[:60]}` is no revision", hint="`pico log` lists them"))
    run(root, [what, "--end-of-options", name, commit], doing=f"make the {what} {name}")
    session.show(named, what, name, commit)


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
