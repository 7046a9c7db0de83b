"""Shows a run while it goes on; Ctrl-C once ends it at a safe waypoint, twice at once."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from ..session import Session, standing
from ..terminal.output import write
from ..views import report as report_view
from ..views.run import Progress

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.running.execution import Execution
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport


class Screen:
    """Lines that stay, and on a terminal one that is overwritten."""

    def __init__(self, session: Session, progress: Progress) -> None:
        self.session, self.progress = session, progress
        self.terminal = sys.stdout.isatty() and not session.json
        self.last = 0.0

    def show(self, event: Event) -> None:
        for before in standing:
            before.begun |= bool(event.operation)
        if self.session.json:
            self.session.document(as_json(event))
            return
        if line := self.progress.line(event):
            self.stay(line)
        elif self.terminal and (live := self.progress.live(event)) and time.monotonic() - self.last > 0.05:
            self.last = time.monotonic()
            write(sys.stdout, live, end="", over=True)

    def stay(self, line: str) -> None:
        self.clear()
        self.session.say(line)

    def clear(self) -> None:
        """Leave the line that is overwritten empty."""
        if self.terminal:
            write(sys.stdout, "", end="", over=True)


def execute(
    session: Session, bench: Bench, plan: Plan, record: Path | None = None, *, after: str | None = None, **options: Any
) -> int:
    """Run a plan, show how it goes and what became of it; return the exit code: see `ran`."""
    return int(ran(session, bench, plan, record, after=after, **options).exit_code)


def ran(
    session: Session, bench: Bench, plan: Plan, record: Path | None = None, *, after: str | None = None, **options: Any
) -> RunReport:
    """Run a plan, show how it goes and what became of it; return that.

    `record`: where a film of it goes; `after`: what to do once it is done; `options` are those of `Moves.run`.
    """
    recording = None
    if record:
        from pico.twin.snapshot import Recording

        recording = Recording()
    options = {"holder": session.command, **options}
    run = bench.run(plan, **{**options, **({"recording": recording} if recording else {})})
    screen = Screen(session, Progress(plan))
    events: list[Event] = []

    def show(event: Event) -> None:
        screen.show(event)
        if record:
            events.append(event)

    came = watched(run, show)
    after = _after(plan) if after is None else after
    undoing = plan.target.cause in ("undo", "redo")
    session.show(report_view, run.report, after=after, undoing=undoing, again=session.words)
    session.tell(run.report.diagnostics)
    light_back(session, bench, plan, run.report)
    if record and recording and recording.snapshots and set(came) <= {signal.SIGINT}:  # else nobody waits for it
        from .filming import film

        film(session, bench, plan, recording, events, record)
    return run.report


def light_back(session: Session, bench: Bench, plan: Plan, report: RunReport) -> None:
    """Show whether the light is as the goal of a plan recorded it, where the plan was to bring that back."""
    if not (plan.target.align and report.outcome == "done" and report.measurements and report.whole):
        return
    from ..views import light_back as view

    found = bench.light.compared(plan.target.revision, report.measurements)
    if found:
        session.show(view, found, goal=plan.target.name, suspects=bench.light.suspected(found))


def _after(plan: Plan) -> str:
    """Return how to keep what a run brought from a revision for some components, and how to go back."""
    if not plan.target.only:
        return ""
    if not plan.target.revision:
        return "Go back with `pico undo`."
    named = f"{plan.target.revision} -- {' '.join(plan.target.only)}"
    keep = f"keep it: `pico checkout {named}`, or `pico commit --capture`"
    return f"The manifest is as it was; {keep}. Go back with `pico undo`."


def watched(run: Execution, show: Callable[[Event], None]) -> tuple[int, ...]:
    """Show a run until it is over, and say what a signal leads to; return the signals that ended it."""
    from pico.bench.running.attending import attend

    return attend(run, show, say)


def say(text: str) -> None:
    """Tell something in the handler of a signal."""
    os.write(2, f"\n{text}\n".encode())  # print is not safe in the handler of a signal
