"""The main job, 3: `pico plan`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pico.diagnostics import ExitCode
from pico.disk import write_whole

from ..arguments import DetailedExit, Exact, Exclude, Fidelity, Out, Prefer, Revision, Scoped, Targets, scope_of
from ..session import Session
from ..views import plan as view

CLASS = Scoped
Explain = Annotated[
    str | None,
    typer.Option("--explain", metavar="COMPONENT", help="Say why the plan does with COMPONENT what it does."),
]

Picture = Annotated[
    Path | None,
    typer.Option(
        "--picture",
        metavar="PNG",
        help="Draw the plan from above, its steps numbered; where it is impossible, who blocks whom in red.",
    ),
]


def plan(
    context: typer.Context,
    revision: Revision = None,
    out: Out = None,
    detailed_exitcode: DetailedExit = False,
    exact: Exact = False,
    fidelity: Fidelity = None,
    explain: Explain = None,
    target: Targets = None,
    exclude: Exclude = None,
    prefer: Prefer = "fewest-moves",
    picture: Picture = None,
) -> int:
    """Show what would move to make the bench equal to the manifest or a revision.

    With names after `--` for these components or single tunables only: `pico plan e1 -- p2 p1.angle`. Nothing moves.
    Exits with 3 where the revision is physically impossible, with 1 on other errors.
    """
    session = Session.of(context)
    bench = session.bench(fidelity)
    named = scope_of(context)
    targets = (*(target or ()), *named)
    found = bench.plan(revision, exact=exact, prefer=prefer, targets=targets, exclude=exclude or ())
    if out and not found.errored:
        write_whole(session.folder / out, (found.to_json() + "\n").encode())
    if explain:
        from .explain import show

        show(session, bench, found, explain)
    else:
        session.show(
            view,
            found,
            head=bench.history.head_name(),
            goal=bench.history.goal_name(found),
            next_step=_next(revision, out, _again(target, exclude, prefer), named),
        )
    session.draw(picture, "the plan", lambda path: bench.pictures.render(view="top", plan=found, out=path))
    if not explain:
        session.tell(found.diagnostics)
    if found.exit_code:
        return found.exit_code
    return ExitCode.CHANGES if detailed_exitcode and not found.reached else ExitCode.DONE


def _next(revision: str | None, out: Path | None, options: str, named: tuple[str, ...]) -> str:
    """Return what to type after a plan."""
    if out:
        return f"Saved. Apply with `pico apply {out if out.is_absolute() else f'./{out}'}`."
    more = f"{f' {revision}' if revision else ''}{options}"
    last = f" -- {' '.join(named)}" if named else ""
    return f"Apply with `pico apply{more}{last}`, or save with `pico plan{more} --out {revision or 'my'}.plan{last}`."


def _again(targets: list[str] | None, exclude: list[str] | None, prefer: str) -> str:
    """Return the options that make the same plan again."""
    words = [f" --target {name}" for name in targets or ()] + [f" --exclude {name}" for name in exclude or ()]
    return "".join([*words, *([f" --prefer {prefer}"] if prefer != "fewest-moves" else [])])
