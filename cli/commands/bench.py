"""`pico bench`."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

import typer

from pico.diagnostics import ExitCode, PicoError

from ..arguments import Yes, group
from ..session import Session, lost_warning
from ..views import benches as benches_view
from ..views import meant as meant_view
from ..views import proposal as view

HEADING = "The simulator, and the rest"
ORDER = 110

app = group(
    help="Which bench commands mean, and its own Lab, which plans go by.",
    examples=("pico bench", "pico bench use emulated", "pico bench update --dry-run"),
    alone=True,
)

Detailed = Annotated[bool, typer.Option("--dry-run", help="Show what differs, and adopt nothing.")]


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_(context)


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the benches of this machine and of known coordinators, and who has them; `pico bench` alone does the same.

    Examples:
      pico bench list
    """
    from pico.edge.network import remotes
    from pico.edge.network.asking import ask
    from pico.history.runs.benches import bench_states
    from pico.manifest.load import find_lab
    from pico.places.bench import BenchPlace

    session = Session.of(context)
    root = find_lab(session.folder)
    known = remotes.known(root)
    found, away = dict[str, Any](), list[PicoError]()
    for name, one in sorted(known.named.items()):
        try:
            found[name] = ask(one, "GET", "/benches")
        except PicoError as exc:  # the others are there
            away.append(exc)
    states = bench_states(root)
    session.show(benches_view, states, found, session.place(root))
    session.tell(tuple(d for state in states for d in lost_warning(BenchPlace(root, state.bench))))
    session.tell([replace(d, severity="warning") for exc in away for d in exc.diagnostics])


@app.command()
def use(
    context: typer.Context,
    bench: Annotated[
        str, typer.Argument(metavar="BENCH", help="`sim`, `emulated`, `hardware`, or LAB/BENCH as in the list.")
    ],
) -> None:
    """Choose the bench that commands mean if they name none.

    Kept by this worktree, never in a commit. `local` is another word for `sim`. `--backend`, `--emulate` and `--bench`
    override it for one command, `PICO_BENCH` for a shell, but that never selects the real bench. `pico test`, `pico
    check` and scripts that name no bench never use the real one.

    Examples:
      pico bench use shel/bench1
      pico bench use emulated
      pico bench use sim
    """
    from pico.edge.network import meant, remotes
    from pico.history.runs.benches import bench_state, require_usable
    from pico.manifest.load import find_lab
    from pico.places.bench import BenchPlace
    from pico.places.choice import write_choice

    session = Session.of(context)
    root = find_lab(session.folder)
    place = meant.named_bench(root, remotes.known(root), bench)
    notes = require_usable(place)
    write_choice(root, meant.word_for(place))
    session.show(meant_view, place, bench_state(place) if isinstance(place, BenchPlace) else None)
    session.tell(notes)


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
    place = session.place(find_lab(session.folder))
    found = updating.proposal(place)
    session.tell(found.renamed)
    if not found.new or dry_run:
        session.show(view, found, adopted=False)
        return ExitCode.DONE
    session.require_answer(auto_approve)
    session.say(view.text(found, adopted=False))
    if not session.confirm("\nAdopt it as the bench's own Lab?", auto_approve):
        session.say("Nothing adopted: the bench stays what it is.")
        return ExitCode.ERROR
    updating.update(place)
    if session.json:
        session.document(view.data(found, adopted=True))
    session.say("Adopted: plans go by it from now on. `pico plan` shows what differs now.")
    return ExitCode.DONE
