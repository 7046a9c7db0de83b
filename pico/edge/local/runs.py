"""Runs on the bench of an edge: judged, begun, carried out, told of and reported, whoever listens."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.edge.kept_lab import KeptLab
from pico.edge.local.apparatus import Apparatus
from pico.edge.local.custody import HALTED, Custody
from pico.edge.local.licensing import Licensing
from pico.edge.local.sight import Sight
from pico.edge.local.started import StartedRuns
from pico.edge.protocol import RECIPE, Job, Lease
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.trace.event import Event

if TYPE_CHECKING:
    from pico.edge.open_run import OpenRun
    from pico.edge.running import Running
    from pico.model.plan import Plan
    from pico.model.trace.report import RunReport
    from pico.model.trace.run import RunOutcome
    from pico.teleop.frames import Answer, Frame


class Runs:
    """The runs of one bench: at most one is in progress, which may be a step of the open one."""

    def __init__(
        self, apparatus: Apparatus, sight: Sight, licensing: Licensing, custody: Custody, kept: KeptLab
    ) -> None:
        self._apparatus, self._sight, self._licensing, self._custody = apparatus, sight, licensing, custody
        self._kept, self.started = kept, StartedRuns()
        self._running: Running | None = None
        self._open: OpenRun | None = None
        self._listeners: list[Callable[[Event], None]] = []

    # runs in progress, for custody of the bench

    @property
    def is_running(self) -> bool:
        """Whether a run, or a step of an open one, is under way."""
        return self._running is not None

    @property
    def is_open(self) -> bool:
        """Whether an open run has the bench."""
        return self._open is not None

    def is_cancelled(self, run: str) -> bool:
        """Return whether nothing more of a run may start."""
        return run in self.started.cancelled

    def hear(self, event: Event) -> None:
        """Take what the device says of an operation."""
        if self._running is not None and self._running.walk is not None:
            self._running.walk.heard(event)

    def interrupt(self) -> None:
        """Start nothing more of the run under way."""
        if self._running is not None and self._running.walk is not None:
            self._running.walk.interrupt()

    async def ended(self) -> None:
        """Wait for the end of the run under way."""
        if self._running is not None and self._running.task is not None:
            await asyncio.wait([self._running.task])

    async def leave(self) -> None:
        """Bring a step of an open run to its end, for the bench is given back."""
        if self._open is not None:
            if self._running is not None:
                await self._custody.halt()
            await self.ended()

    def end_open(self, outcome: RunOutcome = "interrupted") -> None:
        """Write down how the open run ended, if there is one."""
        opened, self._open = self._open, None
        if opened is not None:
            self._apparatus.journals.end(opened.id, outcome, opened.counts())

    def under_way(self) -> str | None:
        """Return the run that an operation belongs to now, None if no run is in progress."""
        under_way = self._open or self._running
        return under_way.id if under_way is not None else None

    # beginning and ending

    async def start(self, job: Job, run: str) -> str:
        """Judge a plan again, and start a run of it; see `pico.edge.contract.EdgeRuns`."""
        if not job.resumes and self.started.is_known(run, job.plan.digest):
            return run
        self._require_unlocked()
        self.started.cancelled.discard(run)  # of an earlier time that it was taken up
        running = self._new(job, run)
        lease = self._step_of(job) if job.within else await self._taken(job, running)
        try:
            seen, able = await self._permitted(job.plan)
            await self._custody.shut_over(seen)
            if not job.within:
                self._begin(job, run, able, lease)
        except BaseException:
            if not job.within:
                await self._custody.leave()
            raise
        self.started.add(running)
        self._running = running
        self._custody.halted |= self.is_cancelled(run)
        running.task = asyncio.create_task(self._carry_out(job, running, lease, seen.time))
        running.task.add_done_callback(running.over)
        return run

    async def open(self, job: Job, run: str) -> Lease:
        """Take the bench and begin a run that stays open; see `pico.edge.contract.EdgeRuns`."""
        from pico.edge.open_run import OpenRun

        self._require_unlocked()
        lease = await self._taken(job, self._new(job, run))
        try:
            seen, able = await self._permitted(job.plan)
            await self._custody.shut_over(seen)
            self._begin(job, run, able, lease)
        except BaseException:
            await self._custody.leave()
            raise
        self._open = OpenRun(run, job.plan)
        return lease

    def _require_unlocked(self) -> None:
        """Raise PicoError if a person at the table lets this work not begin."""
        from pico.edge.guard.table_lock import require

        require(self._apparatus.place, alone=self._licensing.alone.goes)

    async def finish(self, run: str, outcome: RunOutcome) -> RunReport:
        """End an open run and give the bench back; see `pico.edge.contract.EdgeRuns`."""
        from pico.edge.about import seen_after
        from pico.edge.open_run import not_open

        opened = self._open
        if opened is None or opened.id != run:
            raise PicoError(not_open(run), ExitCode.INTERRUPTED)
        await self.ended()
        try:
            seen, able = await self._sight.observe(), await self._apparatus.describe()
            report = opened.report("interrupted" if self._custody.halted else outcome, seen, able)
            report = replace(report, diagnostics=self._licensing.notices())
            self.end_open(report.outcome)
            self._apparatus.journals.journal.saw(run, seen_after(seen, (), reached=False))
        finally:
            await self._custody.leave()
        return report

    async def cancel(self, run: str) -> None:
        """Start nothing more of a run, and bring everything to a safe end."""
        self.started.cancelled.add(run)
        if self._running is not None and self._running.id == run:
            await self._custody.halt_for_client()

    async def _taken(self, job: Job, running: Running) -> Lease:
        """Take the bench for a run, at its speed; raises PicoError if its plan is not for this bench."""
        from pico.policy.judging.case import PlanCase
        from pico.policy.judging.judges import require_permitted

        own = self._apparatus
        self._licensing.hear(job.holder.removeprefix(f"{RECIPE} "))
        able = replace(await own.describe(), lab_digest=own.usual.at_speed(job.speed).digest())
        require_permitted(PlanCase(own.setup, job.plan, able=able, axes=own.calibrated_axes))

        def prepare() -> None:
            own.go_at(job.speed)
            own.device.watch(running.recording.look if running.recording else None)

        return await self._custody.take(job.holder, job.wait, running.id, prepare)

    async def _permitted(self, plan: Plan) -> tuple[Observation, Capabilities]:
        """Return the bench as it is and what it can do, once all judges have let a plan pass; raises PicoError."""
        from pico.policy.judging.case import PlanCase
        from pico.policy.judging.judges import require_permitted

        able, seen = await self._apparatus.describe(), await self._sight.observe()
        doses = self._licensing.doses_until(seen) if plan.operations else ()
        own = self._apparatus
        require_permitted(PlanCase(own.setup, plan, seen, able, doses, axes=own.calibrated_axes))
        return seen, able

    def _step_of(self, job: Job) -> Lease:
        """Return the lease of the open run that a job is a step of; raises PicoError if that can't begin now."""
        from pico.edge.open_run import not_open

        lease = self._custody.lease
        if self._open is None or lease is None or self._open.id != job.within:
            raise PicoError(not_open(str(job.within)), ExitCode.INTERRUPTED)
        if self._custody.halted:
            raise PicoError(HALTED, ExitCode.INTERRUPTED)
        if self._running is not None:
            text = f"a step of run {job.within} is under way"
            raise PicoError(error("run", text, hint="what runs side by side is one plan, such as of several `set`"))
        if job.filmed or job.resumes:
            text = "a step of an open run is neither filmed nor taken up by itself"
            raise PicoError(error("run", text, hint="run it outside of it"))
        return lease

    def _new(self, job: Job, run: str) -> Running:
        from pico.edge.running import Running
        from pico.twin.snapshot import Recording

        return Running(run, job.plan.digest, Recording() if job.filmed else None)

    def _begin(self, job: Job, run: str, able: Capabilities, lease: Lease) -> None:
        from pico.edge.about import about_run

        about = {**about_run(self._apparatus.setup, job.plan, able), **self._licensing.about()}
        journals = self._apparatus.journals
        if job.resumes:
            journals.journal.resume_run(run, about)
        else:
            plan = job.plan
            journals.journal.begin_run(run, plan.digest, lease.holder, document=plan.to_json(), about=about)
        journals.begun(run)

    # carrying out

    async def _carry_out(self, job: Job, running: Running, lease: Lease, now: float) -> RunReport:
        """Walk a plan to its end, whoever listens, and return what became of it."""
        from pico.execution.walk import Walk

        custody = self._custody

        async def execute(operation: Operation, key: str) -> OperationResult:
            return await custody.execute(operation, key, lease, tidies=walk.sets_back(operation))

        began, around = time.monotonic(), self._open
        if around is not None:
            job = replace(job, plan=around.step(job.plan))
        walk = Walk(
            job.plan, execute, lambda event: self._tell(running, event), run=around.id if around else running.id,
            now=now, stop_on_error=job.stop_on_error,
        )  # fmt: skip
        running.walk = walk
        try:
            await walk.walk()
            return await self._reported(job, running, time.monotonic() - began)
        finally:
            self._running = None
            self.started.cancelled.discard(running.id)
            if around is None:
                await custody.release(lease)

    def _tell(self, running: Running, event: Event) -> None:
        """Write down how a run ended before anyone hears of it, and log what happens."""
        try:
            if event.kind == "run_finished" and self._open is not None:
                self._open.count(event)
            elif event.kind == "run_finished":
                tally = {k: v for k, v in event.data.items() if k != "outcome"}
                self._apparatus.journals.end(running.id, event.data["outcome"], tally)
        finally:  # a journal that is gone must not hide what became of the run
            running.tell(event)
            for listener in tuple(self._listeners):
                listener(event)

    async def _reported(self, job: Job, running: Running, wall: float) -> RunReport:
        """Look at the bench after a run, write down how it stands, and return what became of the run.

        Raises PicoError if nothing can be seen any more, with what went wrong before.
        """
        from pico.edge.about import seen_after
        from pico.execution.report import measured, run_report, told_by

        able = await self._apparatus.describe()
        events = [e for e in running.log if e.kind != "operation_progress"]
        try:
            seen = replace(await self._sight.observe(), measurements=measured(job.plan, events))
        except PicoError as exc:
            raise PicoError([*told_by(events), *exc.diagnostics], exc.exit_code) from exc
        report = run_report(self._apparatus.setup, job.plan, events, seen, wall=wall, able=able)
        reached = report.whole and report.outcome == "done" and report.reached and not report.by_light
        more = (*self._kept.told(), *self._licensing.notices(), *self._why(report))
        report = replace(report, diagnostics=(*report.diagnostics, *more))
        if self._open is not None:
            return report
        try:
            after = seen_after(seen, report.expectations, reached=reached)
            self._apparatus.journals.journal.saw(running.id, after)
        except PicoError as exc:  # it must not hide the report
            return replace(report, diagnostics=(*report.diagnostics, *exc.diagnostics))
        return report

    def _why(self, report: RunReport) -> tuple[Diagnostic, ...]:
        """Return why a run was interrupted, if its client does not know."""
        why = self._custody.why_ended() if report.outcome == "interrupted" else ""
        return (warning("ended", why),) if why else ()

    # following

    def listen(self, listener: Callable[[Event], None]) -> Callable[[], None]:
        """Have somebody told from now on what happens in runs; return what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def jog(self, run: str, frame: Frame) -> Answer:
        """Say what a hand on a key says to the teleoperation in a run; see `pico.edge.contract.EdgeRuns`."""
        from pico.teleop.frames import over

        self.started[run]
        steering = self._custody.steering
        if steering is None or self._running is None or self._running.id != run:
            return over(time.monotonic())
        return steering.hear(frame)
