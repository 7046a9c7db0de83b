"""One run of all that is done on a bench while it is recorded: `with bench.record("scan") as run:`.

The bench is taken once, and each thing that is set, moved, measured, optimized or steered is a step of the run, checked
as if it were alone. What interrupts the block ends the run as interrupted, an exception as failed.
"""

from __future__ import annotations

import signal
import threading
from html import escape
from typing import TYPE_CHECKING, Any, Self

from pico.bench.opened import Opened
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.protocol import RECIPE, RECORDING, Job
from pico.edge.running import new_run_id
from pico.model.observation import live_state
from pico.model.plan import Plan, Target
from pico.model.trace.report import RunReport
from pico.model.trace.run import RunOutcome
from pico.scripting.tables import Table

if TYPE_CHECKING:
    from pico.model.measurement import Measurement
    from pico.runs.document import RecordedRun

ENDING = (signal.SIGTERM, signal.SIGHUP)
"""Signals that end the block as Ctrl-C does, so that its run is told as interrupted."""


class Recording:
    """One run called `name`, with the id `id` from when it is entered, and a `report` once it is over."""

    def __init__(self, opened: Opened, name: str, target: Target | None = None) -> None:
        """`target`: what the run is for, where it is not what somebody recorded."""
        self.opened, self.name, self.id = opened, name, ""
        self._target = target or Target(title=name, cause="recording")
        self._report: RunReport | None = None
        self._handlers: dict[int, Any] = {}

    def __repr__(self) -> str:
        how = self._report.outcome if self._report else "open" if self.id else "not begun"
        return f"<run {self.name}: {how}{f', {self.id}' if self.id else ''}>"

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        if self._report is None:
            raise RuntimeError("the run is not over: leave its block first")
        return self._report

    @property
    def measurements(self) -> tuple[Measurement, ...]:
        """All that was measured in the run until now, in the order of the measurements."""
        from pico.model.measurement import measurement_from_json

        memory = self.opened.edge.memory
        records = memory.records(run=self.id) if memory is not None and self.id else ()
        found = (r.data.get("data", {}).get("measurement") for r in records if r.kind == "done")
        return tuple(measurement_from_json(one) for one in found if one)

    @property
    def recorded(self) -> RecordedRun:
        """The run with its trace until now; raises PicoError where nothing was done in it yet."""
        memory = self.opened.edge.memory
        if not self.id or memory is None or not memory.records(run=self.id):
            raise PicoError(error("nothing", f"nothing was done in the run {self.name} yet"))
        return self.opened.history.recorded_run(self.id)[0]

    @property
    def table(self) -> Table:
        """What was measured in the run until now, a row each, beside the tunables that it changed; raises PicoError
        where nothing was done in it yet."""
        return Table(self.opened.setup, self.recorded)

    def _repr_html_(self) -> str:
        try:
            return self.recorded._repr_html_()
        except PicoError:
            return f"<div>{escape(repr(self))}</div>"

    def __enter__(self) -> Self:
        """Take the bench; raises PicoError where somebody else has it (exit code LOCKED), or records on it already."""
        opened = self.opened
        if opened.recording is not None:
            raise PicoError(error("recording", f"run {opened.recording} is being recorded: a run has no run within it"))
        if self.id:
            raise PicoError(error("recording", f"run {self.id} is over", hint="`bench.record(...)` begins another"))
        run = new_run_id()
        of = self._target.recipe
        holder = f"{RECIPE} {of}" if of else f"{RECORDING} {self.name}"
        job = Job(plan=self._plan(), holder=holder, wait=opened.lock_timeout, speed=opened.speed)
        opened.wait(opened.edge_for(None).open(job, run))
        self.id = opened.recording = run
        if threading.current_thread() is threading.main_thread():
            self._handlers = {n: h for n in ENDING if (h := signal.getsignal(n)) == signal.SIG_DFL}
            for number in self._handlers:
                signal.signal(number, _ended_by)
        return self

    def __exit__(self, kind: type[BaseException] | None, exc: BaseException | None, _: object) -> None:
        try:
            self.end(_outcome(exc))
        except PicoError:
            if kind is None:
                raise

    def end(self, how: RunOutcome) -> None:
        """End the run, and give the bench back; raises PicoError where it is not open any more."""
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self.opened.recording = None
        self._report = self.opened.wait(self.opened.edge.finish(self.id, how))

    def _plan(self) -> Plan:
        """Return the plan of a run whose operations are asked for while it is open."""
        from pico.bench.plans import Plans
        from pico.planning import PlanGoal

        opened = self.opened
        seen = opened.wait(opened.edge.observe())
        return Plans(opened).planner(seen).plan(PlanGoal(live_state(opened.setup, seen), self._target, operations=()))


def _outcome(exc: BaseException | None) -> RunOutcome:
    if exc is None:
        return "done"
    stopped = isinstance(exc, PicoError) and exc.exit_code == ExitCode.INTERRUPTED
    return "failed" if isinstance(exc, Exception) and not stopped else "interrupted"


def _ended_by(number: int, _: object) -> None:
    raise SystemExit(128 + number)
