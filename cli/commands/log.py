"""`pico log`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import Scoped, scope_of
from ..session import Session
from ..terminal.paging import paged
from ..views import log as view

HEADING = "History"
ORDER = 30

if TYPE_CHECKING:
    from pico.history.lab_history import LabHistory

Words = Annotated[
    list[str] | None,
    typer.Argument(metavar="[REV|A..B|^A]...", help="Commits, ranges, and what is to be left out; HEAD for none."),
]
SETTINGS, CLASS = {"ignore_unknown_options": True}, Scoped
_COUNT = re.compile(r"-(\d{1,9})")


def log(
    context: typer.Context,
    revisions: Words = None,
    graph: Annotated[bool, typer.Option("--graph", help="Draw the branches; shows all of them.")] = False,
    oneline: Annotated[bool, typer.Option("--oneline", help="One line a commit.")] = False,
    every: Annotated[bool, typer.Option("--all", help="Show all branches and tags, not only HEAD.")] = False,
    number: Annotated[
        int | None, typer.Option("-n", "--number", min=1, max=10**9, help="At most so many commits.")
    ] = None,
    since: Annotated[str | None, typer.Option(metavar="DATE", help="Newer than this, as git reads dates.")] = None,
    until: Annotated[str | None, typer.Option(metavar="DATE", help="Older than this.")] = None,
    author: Annotated[str | None, typer.Option(metavar="PATTERN", help="By whom.")] = None,
    grep: Annotated[str | None, typer.Option(metavar="PATTERN", help="With this in the message.")] = None,
    first_parent: Annotated[bool, typer.Option("--first-parent", help="Of a merge, follow the first line.")] = False,
    merges: Annotated[bool, typer.Option("--merges", help="Merges only.")] = False,
    no_merges: Annotated[bool, typer.Option("--no-merges", help="No merges.")] = False,
) -> None:
    """List commits with what each changed on the table.

    With names after `--` only those that changed these components, single tunables, or components that these files
    hold.

    Examples:
      pico log --graph --oneline
      pico log e1 -- p2 p1.angle
    """
    session = Session.of(context)
    words, limit = _counted(revisions or [], number)
    options = [f"--{name}={value}" for name, value in (("since", since), ("until", until), ("author", author),
                                                       ("grep", grep)) if value is not None]  # fmt: skip
    options += [f"--{name}" for name, asked in (("first-parent", first_parent), ("merges", merges),
                                                ("no-merges", no_merges)) if asked]  # fmt: skip
    history = session.history()
    _revisions(history, words)
    found = history.log(
        *words, every=every or (graph and not words), limit=limit, names=scope_of(context), at=session.folder,
        options=options, graph=graph,
    )  # fmt: skip
    if session.json:
        session.document(view.data(found, graph=graph, oneline=oneline, head=history.head_commit()))
        return
    with paged(session):
        for part, notes in found.notes().items():
            session.say(view.noted(part, notes))
        for block in view.blocks(found, graph=graph, oneline=oneline, head=history.head_commit()):
            if not session.say(block):
                break


def _counted(words: list[str], number: int | None) -> tuple[list[str], int | None]:
    """Return the words without `-5`, which is a number of commits; raises PicoError for other options."""
    kept = []
    for word in words:
        if match := _COUNT.fullmatch(word):
            number = int(match[1]) or None
        elif word.startswith("-") and word != "-":
            hint = "`pico log --help` lists them; `git log` has many more, and shows lines"
            raise PicoError(error("usage", f"pico log has no option {word.partition('=')[0]}", hint=hint))
        else:
            kept.append(word)
    return kept, number


def _revisions(history: LabHistory, words: list[str]) -> None:
    """Raise PicoError for a component or a file among the revisions: these go after `--`."""
    for word in words:
        known = word.partition(".")[0] in history.folder.setup.lab.inventory or (history.folder.root / word).is_file()
        if known and not history.is_revision(word):
            raise PicoError(error("revision", f"`{word}` is no revision", hint=f"`pico log -- {word}`"))
