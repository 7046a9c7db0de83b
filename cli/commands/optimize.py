"""`pico optimize`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import DryRun, Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import goals as goals_view
from ..views import optimization as view
from ..views import optimizing as live
from ..views import optimizing_ahead as ahead_view
from ..views import placed as placed_view

HEADING = "One operation at a time"
ORDER = 60

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pico.bench.bench import Bench
    from pico.bench.goals import Chosen
    from pico.bench.placing import Try
    from pico.model.trace.event import Event


def optimize(
    context: typer.Context,
    goal: Annotated[list[str] | None, typer.Argument(metavar="GOAL", help="A goal of `lab.yaml`, or as below.")] = None,
    algorithm: Annotated[str | None, typer.Option("--algorithm", metavar="NAME", help="Instead of the chosen.")] = None,
    plot: Annotated[Path | None, typer.Option("--plot", metavar="PNG", help="Draw how it went.")] = None,
    offline: Annotated[
        float | None,
        typer.Option("--offline", metavar="SECONDS", help="Go on so long where the bench is cut off."),
    ] = None,
    by_arm: Annotated[bool, typer.Option("--by-arm", help="`center`: the arm puts the part down anew.")] = False,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Set and measure until light is as a goal wants it.

    The best is kept. Without a goal those that there are are listed: `goals:` of `lab.yaml`, and ready made ones
    with the words that they take (`center PART CAMERA`, `through IRIS IRIS`, `fiber COUPLER`). Ctrl-C ends at the
    best point; so does a bench that is cut off from its coordinator, once its lease is over and what `--offline` (or
    `offline` in the goal's `budget`) says is spent. The exit code is 6 where the goal was not met; `pico undo` goes
    back.

    Examples:
      pico optimize center ly_150 cam
      pico optimize null p2 cam --plot null.png
      pico optimize through iris1 iris2 --dry-run
      pico optimize centred --dry-run
      pico optimize center lens camera --by-arm
    """
    from pico.diagnostics import PicoError, error

    session = Session.of(context)
    bench = session.bench(fidelity, None, writing=bool(goal) and not dry_run)
    if not goal:
        from pico.bench.ready.registry import takes

        ready, broken = takes()
        session.show(goals_view, bench.goals.named, bench.goals.alignments(), ready)
        session.tell(broken)
        return 0
    if by_arm:
        if offline is not None:
            raise PicoError(error("usage", "--offline goes with goals that motors reach, and not with --by-arm"))
        return _by_arm(session, bench, goal, dry_run, auto_approve)
    return _optimize(
        session, bench, bench.goals.chosen(goal, algorithm=algorithm, offline=offline), plot, dry_run, auto_approve
    )


def _by_arm(session: Session, bench: Bench, goal: list[str], dry_run: bool, auto_approve: bool) -> int:
    from pico.bench.ready.registry import current
    from pico.diagnostics import ExitCode, PicoError, error

    from ..runs.approving import declined, show
    from ..runs.running import say

    if len(goal) != 3 or current(goal)[0] != "center":
        raise PicoError(error("usage", "--by-arm goes with `center PART CAMERA`"))
    placing = bench.placing
    plan = placing.plan(goal[1])  # what each try is like
    told = plan.operations or plan.errored or session.json
    if told and (code := show(session, bench, plan, auto_approve or dry_run, single=True)):
        return int(code)
    if dry_run or not plan.operations:
        session.say(placed_view.ahead(goal[1], goal[2]))
    if dry_run:
        return 0
    if code := declined(session, bench, plan, auto_approve):
        return int(code)

    def tell(one: Try) -> None:
        if not session.json:
            session.say(placed_view.line(one))

    found = placing.center(goal[1], goal[2], say=say, tell=tell)
    session.show(placed_view, found)
    return int(ExitCode.DONE if found.met else ExitCode.EXPECTATION)


def _optimize(
    session: Session, bench: Bench, chosen: Chosen, plot: Path | None, dry_run: bool, auto_approve: bool
) -> int:
    from pico.diagnostics import ExitCode
    from pico.optimize.loop import STOPPED

    from ..runs.approving import declined, show
    from ..runs.running import say
    from ..terminal.output import write

    cautions = bench.goals.cautions(chosen)
    session.tell(cautions)
    plan = bench.goals.plan(chosen)
    more = plan.errored or (len(plan.operations) > 1 and not session.json)
    code = show(session, bench, plan, auto_approve or dry_run, single=True) if more else 0
    if code:
        return int(code)
    if dry_run:
        session.show(ahead_view, chosen, bench.setup, cautions=cautions)
        return 0
    if code := declined(session, bench, plan, auto_approve):
        return int(code)
    session.name_bench()
    terminal = sys.stdout.isatty() and not session.json

    def heard(event: Event) -> None:
        if session.json:
            session.document(live.data(event))
        elif terminal and (line := live.line(event, chosen, bench.setup)):
            write(sys.stdout, line, end="", over=True)

    report, found = bench.goals.optimize(plan, heard, say)
    if terminal:
        write(sys.stdout, "", end="", over=True)
    dark = bench.measurements.dark() if found.columns and not found.last else ""
    dark = "shorten the exposure, or put a filter before the detector" if dark and found.saturated else dark
    began: Mapping[str, float] = next(
        (op.arguments["from"] for op in plan.operations if op.primitive == "optimize"), {}
    )
    session.show(view, found, chosen, bench.setup, report, advice=dark, began=began, cautions=cautions)
    session.tell(report.diagnostics)
    if found.points:
        session.draw(plot, chosen.name, lambda path: bench.goals.plot(found, chosen.goal, path))
    if report.exit_code:
        return int(report.exit_code)
    if found.why == STOPPED:
        return int(ExitCode.INTERRUPTED)
    return int(ExitCode.DONE if found.met else ExitCode.EXPECTATION)
