"""`pico plan`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import write_whole

from ..arguments import (
    Align,
    DetailedExit,
    Exact,
    Exclude,
    Fidelity,
    NoAlign,
    PlanOrRevision,
    Prefer,
    Scoped,
    aligning,
    scope_of,
)
from ..session import Session
from ..views import plan as view

HEADING = "The main job"
ORDER = 30

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan

CLASS = Scoped
MERMAID, DRAWN = (".mmd", ".mermaid", ".md"), (".svg", ".png", ".pdf")
Out = Annotated[Path | None, typer.Option("--out", metavar="FILE", help="Save it; with --graph FILE.dot or FILE.mmd.")]
Explained = Annotated[str | None, typer.Argument(metavar="COMPONENT", help="With --explain: tell all about this one.")]
Explain = Annotated[bool, typer.Option("--explain", help="Why each move, in this order, and not less.")]
Graph = Annotated[bool, typer.Option("--graph", help="What waits for what; the critical path.")]
Format = Annotated[
    Literal["dot", "mermaid"] | None,
    typer.Option("--format", metavar="dot|mermaid", help="Of --graph, for a program that draws."),
]
Picture = Annotated[
    Path | None,
    typer.Option("--picture", metavar="PNG", help="Draw it from above, steps numbered."),
]

Frames = Annotated[bool, typer.Option("--frames", help="And what would move when, to be drawn moment by moment.")]


def plan(
    context: typer.Context, what: PlanOrRevision = None, component: Explained = None, out: Out = None,
    explain: Explain = False, graph: Graph = False, form: Format = None, picture: Picture = None,
    frames: Frames = False, align: Align = False, no_align: NoAlign = False,
    exact: Exact = False, exclude: Exclude = None, prefer: Prefer = "fewest-moves", fidelity: Fidelity = None,
    detailed_exitcode: DetailedExit = False,
) -> int:  # fmt: skip
    """Show what would move to make the bench as wanted. Moves nothing.

    As the manifest wants it, or a revision; with names after `--` for these components or single tunables only. Exits
    with 3 where that is physically impossible, with 7 where policy denies it.

    Examples:
      pico plan e1 -- p2 p1.angle
      pico plan e1 --out e1.plan
      pico plan e1 --explain p2
      pico plan e1 --graph --format dot | dot -Tsvg > plan.svg
    """
    from pico.bench.in_use import goes_on

    _require(explain, graph, component, form)
    session = Session.of(context)
    bench = session.bench(fidelity)
    if explain and component is None and what in bench.setup.lab.inventory:
        what, component = None, what
    named = scope_of(context)
    seek = aligning(align, no_align)
    options = {
        "align": seek,
        "exact": exact,
        "prefer": prefer,
        "targets": named,
        "exclude": exclude or (),
    }
    found = bench.plans.plan_of(what, folder=session.folder, **options)
    saved = what is not None and not isinstance(bench.history.find(what, session.folder), str)
    refused = bench.plans.refusal(found) if saved else None
    if refused is not None:  # what an edge would say of it now
        new = [one for one in refused.diagnostics if one not in found.diagnostics]
        found = replace(found, diagnostics=(*found.diagnostics, *new))
    meanwhile = goes_on(bench)
    session.tell(meanwhile)
    if graph:
        _graph(session, bench, found, form, out, what)
    elif out and not found.errored:
        write_whole(session.folder / out, (found.to_json() + "\n").encode())
    if explain:
        _explain(session, bench, found, component)
    elif not graph:
        step = f"Apply with `pico apply {what}`." if saved else _next(what, out, _again(exclude, prefer, seek), named)
        if meanwhile:
            step = "A run goes on: plan again when it is over."
        session.show(view, found, **_named(bench, found), next_step=step)
    if frames:
        _frames(session, bench, found)
    session.draw(picture, "the plan", lambda path: bench.pictures.render(view="top", plan=found, out=path))
    if not explain:
        session.tell(found.diagnostics)
    if refused is not None:
        return refused.exit_code
    if found.exit_code:
        return found.exit_code
    return ExitCode.CHANGES if detailed_exitcode and not found.reached else ExitCode.DONE


def _frames(session: Session, bench: Bench, found: Plan) -> None:
    """Show what would move; with --json as a document after the plan."""
    from pico.bench.picturing.frames import frames_of_plan

    from ..views import framed

    made, told = frames_of_plan(bench.setup, found, bench.observe())
    session.say("")
    session.show(framed, made)
    session.tell(told)


def _require(explain: bool, graph: bool, component: str | None, form: str | None) -> None:
    """Raise PicoError for options that contradict each other."""
    if explain and graph:
        raise PicoError(error("usage", "--explain and --graph are two answers", hint="ask for one of them"))
    if component is not None and not explain:
        hint = "only --explain takes a component here"
        raise PicoError(error("usage", f"extra argument `{component}`: components go after `--`", hint=hint))
    if form and not graph:
        raise PicoError(error("usage", "--format goes with --graph"))


def _named(bench: Bench, found: Plan) -> dict[str, str]:
    return {"head": bench.history.head_name(), "goal": bench.history.goal_name(found)}


def _explain(session: Session, bench: Bench, found: Plan, component: str | None) -> None:
    """Show why a plan is as it is, or what it does with one component."""
    from ..views import explain

    told = bench.plans.explain(found, component)
    session.show(explain, found, told, **_named(bench, found))
    session.tell(told.diagnostics)


def _graph(session: Session, bench: Bench, found: Plan, form: str | None, out: Path | None, what: str | None) -> None:
    """Show a plan as a graph, or write it for a program that draws."""
    from pico.planning.explaining.graph import graph_of

    from ..views import graph, picture

    made, draw = graph_of(found), {"dot": graph.dot, "mermaid": graph.mermaid}
    drawn = f"`pico plan{f' {what}' if what else ''} --graph --format dot | dot -Tsvg > plan.svg` draws it"
    if out:
        if out.suffix in DRAWN:
            raise PicoError(error("usage", f"--graph writes DOT or Mermaid, not {out.suffix}", hint=drawn))
        kind = form or ("mermaid" if out.suffix in MERMAID else "dot")
        path = session.folder / out
        write_whole(path, (draw[kind](found, made) + "\n").encode())
        goal = bench.history.goal_name(found)
        session.show(picture, path, shown=out, what=f"the graph of the plan for {goal}")
    elif form and not session.json:
        session.say(draw[form](found, made))
    else:
        session.show(graph, found, made, **_named(bench, found), next_step=f"{drawn}.")


def _next(what: str | None, out: Path | None, options: str, named: tuple[str, ...]) -> str:
    """Return what to type after a plan."""
    if out:
        return f"Saved. Apply with `pico apply {out if out.is_absolute() else f'./{out}'}`."
    more = f"{f' {what}' if what else ''}{options}"
    last = f" -- {' '.join(named)}" if named else ""
    return f"Apply with `pico apply{more}{last}`, or save with `pico plan{more} --out {what or 'my'}.plan{last}`."


def _again(exclude: list[str] | None, prefer: str, align: bool | None) -> str:
    """Return the options that make the same plan again."""
    words = [f" --exclude {name}" for name in exclude or ()]
    words += [" --align" if align else " --no-align"] if align is not None else []
    return "".join([*words, *([f" --prefer {prefer}"] if prefer != "fewest-moves" else [])])
