"""`pico checkout`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace

from ..arguments import Fidelity, LockTimeout, Scoped, Yes, scope_of
from ..runs.approving import declined, show
from ..runs.running import execute
from ..session import Session
from ..views import checkout as view

HEADING = "The main job"
ORDER = 100

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.history.restoring.selected import SelectedParts
    from pico.model.plan import Plan

CLASS = Scoped
FilesOnly = Annotated[bool, typer.Option("--files-only", help="Only the files; the bench stays as it is.")]


def checkout(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="A branch, tag or commit.")],
    auto_approve: Yes = False,
    files_only: FilesOnly = False,
    fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:
    """Go to a revision: files and bench.

    Plans from the revision's own files, asks, runs `git checkout`, then moves the bench. With names after `--` only
    these components or single tunables are taken from REV into the manifest, value by value. Refused where edits that
    are not committed would be lost, save by `HEAD -- COMPONENT`, which drops those of the component. If a move fails,
    the files stay at REV and `pico status` tells the truth.

    Examples:
      pico checkout e1
      pico checkout e1 -- p2 p1.angle
    """
    session = Session.of(context)
    bench = session.bench(fidelity, writing=True)
    named = scope_of(context)
    what = bench.history.parts_at(revision, named) if named else revision
    before = bench.history.here()
    if files_only:
        return _files(session, bench, what, before)
    plan = bench.plans.checkout_plan(what)
    goal = bench.history.goal_name(plan) if isinstance(what, str) else view.goal(bench.history.name_of(revision))
    if code := show(session, bench, plan, auto_approve, head=bench.history.head_name(), goal=goal):
        return code
    if code := declined(session, bench, plan, auto_approve, "Nothing moved; the files are where they were."):
        return code
    return _go(session, bench, what, plan, before)


def _go(session: Session, bench: Bench, what: str | SelectedParts, plan: Plan, before: str) -> int:
    """Bring files and bench there, and return the exit code."""
    if plan.operations and isinstance(bench.place, BenchPlace):
        require_attached(bench.place)
    bench.history.checkout(what)
    if isinstance(what, str):
        way = f" Go back with `pico checkout {before}`." if before != bench.history.here() else ""
        session.say(f"\nThe files are at {bench.history.head_name()}.{way}")
        back = ""
    else:
        session.say(f"\n{view.text(what)}")
        back = view.next_step(what)
    if plan.operations:
        return execute(session, bench, plan, after=back)
    session.say(back)
    return ExitCode.DONE


def _files(session: Session, bench: Bench, what: str | SelectedParts, before: str) -> int:
    """Bring the files there and nothing else."""
    if isinstance(what, str):
        bench.folder.refuse_edits()
    bench.history.checkout(what)
    if session.json:
        session.document(view.data(what, commit=bench.history.head_commit()))
        return ExitCode.DONE
    if isinstance(what, str):
        session.say(f"The files are at {bench.history.head_name()}; nothing moved: `pico plan` shows what would.")
        session.say(f"Go back with `pico checkout {before} --files-only`.")
    else:
        session.say(f"{view.text(what)}\nNothing moved: `pico plan` shows what would.")
        session.say(view.next_step(what, files_only=True))
    return ExitCode.DONE
