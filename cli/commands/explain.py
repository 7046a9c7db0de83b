"""The main job, 10: `pico explain`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode

from ..arguments import Fidelity, PlanOrRevision
from ..session import Session
from ..views import explain as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan


def explain(
    context: typer.Context,
    what: PlanOrRevision = None,
    component: Annotated[
        str | None, typer.Argument(metavar="COMPONENT", help="Tell all about this one; without it all, in short.")
    ] = None,
    fidelity: Fidelity = None,
) -> int:
    """Say why a plan moves what it moves, why in this order, and why not less.

    Each edge of the order is told with the overlap that it avoids. `pico explain p2` explains what the plan to the
    manifest does with p2.
    """
    session = Session.of(context)
    bench = session.bench(fidelity)
    if component is None and what in bench.setup.lab.inventory:
        what, component = None, what
    plan = bench.plans.plan_of(what, folder=session.folder)
    return show(session, bench, plan, component)


def show(session: Session, bench: Bench, plan: Plan, component: str | None) -> int:
    """Show the explanation of a plan, or of one component in it, and return the exit code."""
    found = bench.plans.explain(plan, component)
    session.show(view, plan, found, head=bench.history.head_name(), goal=bench.history.goal_name(plan))
    session.tell(found.diagnostics)
    return ExitCode.IMPOSSIBLE if plan.errored else ExitCode.DONE
