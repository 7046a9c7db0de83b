"""The main job, 11: `pico graph`."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

from pico.diagnostics import ExitCode
from pico.disk import write_whole

from ..arguments import Fidelity, Out, PlanOrRevision
from ..session import Session
from ..views import graph as view
from ..views import picture as written

FORMATS = {"dot": view.dot, "mermaid": view.mermaid}
_SUFFIXES = {".mmd": "mermaid", ".mermaid": "mermaid", ".md": "mermaid"}


def graph(
    context: typer.Context,
    what: PlanOrRevision = None,
    form: Annotated[
        Literal["dot", "mermaid"] | None,
        typer.Option("--format", metavar="dot|mermaid", help="For a program that draws graphs."),
    ] = None,
    out: Out = None,
    fidelity: Fidelity = None,
) -> int:
    """Show a plan as a graph: what waits for what, and the critical path.

    Without --format: the operations that decide when the plan ends, and what the others have to spare. With --out the
    ending of FILE tells the format where --format does not (.mmd is Mermaid, anything else DOT).
    """
    from pico.planning.explaining.graph import graph_of

    session = Session.of(context)
    bench = session.bench(fidelity)
    plan = bench.plans.plan_of(what, folder=session.folder)
    found = graph_of(plan)
    if out:
        kind = form or _SUFFIXES.get(out.suffix, "dot")
        path = session.folder / out
        write_whole(path, (FORMATS[kind](plan, found) + "\n").encode())
        session.show(written, path, shown=out, what=f"the graph of the plan for {bench.history.goal_name(plan)}")
    elif form and not session.json:
        session.say(FORMATS[form](plan, found))
    else:
        goal = bench.history.goal_name(plan)
        step = f"`pico graph{f' {what}' if what else ''} --format dot | dot -Tsvg > plan.svg` draws it."
        session.show(view, plan, found, head=bench.history.head_name(), goal=goal, next_step=step)
    session.tell(plan.diagnostics)
    return ExitCode.IMPOSSIBLE if plan.errored else ExitCode.DONE
