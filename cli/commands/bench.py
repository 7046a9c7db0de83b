"""The simulator, and the rest, 11: `pico bench`."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

import typer

from pico.diagnostics import ExitCode, PicoError

from ..arguments import Yes, group
from ..session import Session
from ..views import benches as benches_view
from ..views import meant as meant_view
from ..views import proposal as view

app = group(
    help="Which bench commands mean, and its own Lab, which plans go by.",
    examples=("pico bench list", "pico bench use shel/bench1", "pico bench update --dry-run"),
)

Detailed = Annotated[bool, typer.Option("--dry-run", help="Show what differs, and adopt nothing.")]


@app.callback()
def _group() -> None: ...


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the benches of the coordinators that this checkout knows, and who has them.

    Examples:
      pico bench list
    """
    from pico.edge.network import remotes
    from pico.edge.network.asking import ask
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    known = remotes.known(root)
    found, away = dict[str, Any](), list[PicoError]()
    for name, one in sorted(known.named.items()):
        try:
            found[name] = ask(one, "GET", "/benches")
        except PicoError as exc:  # the others are there
            away.append(exc)
    if away and not found:
        raise away[0]
    session.show(benches_view, found, remotes.chosen(root, session.at))
    session.tell([replace(d, severity="warning") for exc in away for d in exc.diagnostics])


@app.command()
def use(
    context: typer.Context,
    bench: Annotated[str, typer.Argument(metavar="LAB/BENCH", help="As in the list; `local`: this checkout's own.")],
) -> None:
    """Let commands mean a bench where none is said.

    Kept by this checkout, never in a commit.

    Examples:
      pico bench use shel/bench1
      pico bench use local
    """
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    known = remotes.known(root)
    default = "" if bench == remotes.LOCAL else "/".join(remotes.named(known, bench))
    remotes.keep(root, replace(known, default=default))
    session.show(meant_view, remotes.chosen(root))


@app.command()
def update(context: typer.Context, auto_approve: Yes = False, dry_run: Detailed = False) -> int:
    """Show where the lab's files describe another bench, and adopt that.

    The bench keeps its Lab (table, inventory, robots, cameras, policy, its component types) since it was moved first:
    plan and apply go by it, also at an old commit. An edited lab.yaml is a proposal until it is adopted here. Nothing
    moves. Exit code 1 where somebody says no, 5 where the bench is in use.

    Examples:
      pico bench update --dry-run
    """
    from pico.bench import updating
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    far = session.far(root)
    found = updating.proposal(root, far)
    if not found.new or dry_run:
        session.show(view, found, adopted=False)
        return ExitCode.DONE
    session.require_answer(auto_approve)
    session.say(view.text(found, adopted=False))
    if not session.confirm("\nAdopt it as the bench's own Lab?", auto_approve):
        session.say("Nothing adopted: the bench stays what it is.")
        return ExitCode.ERROR
    updating.update(root, session.backend, far)
    if session.json:
        session.document(view.data(found, adopted=True))
    session.say("Adopted: plans go by it from now on. `pico plan` shows what differs now.")
    return ExitCode.DONE
