"""The edge in this process: composes a device with the lock, the journal, execution and policy of one bench."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING

from pico.backends.device import Capabilities, Device, Shown
from pico.backends.devices import opener
from pico.backends.world import World
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.edge import own_lab
from pico.edge.kept_lab import KeptLab
from pico.edge.lease import BenchLock, from_afar, utc_now
from pico.edge.protocol import RECIPE, UNATTENDED, Granting, Holder, Job, Lease, OwnLab
from pico.edge.remembering import Remembering
from pico.edge.started import StartedRuns
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.edge.aligning import Stopping
    from pico.edge.armings import Kept
    from pico.edge.attempts import Attempts, Executing
    from pico.edge.open_run import OpenRun
    from pico.edge.protocol import Asking
    from pico.edge.recovery import SettledOperation
    from pico.edge.running import Running
    from pico.edge.shutting import Shutting
    from pico.edge.teleoperating import Teleoperating
    from pico.edge.unattended import Alone
    from pico.model.arming import Arming
    from pico.model.plan import Plan
    from pico.model.trace.dose import Dose
    from pico.model.trace.report import RunReport
    from pico.model.trace.run import RunOutcome
    from pico.model.trace.unattended import Left, Terms
    from pico.runs.journal import Journal
    from pico.teleop.frames import Answer, Frame
    from pico.twin.moment import Moment
    from pico.twin.snapshot import Snapshot

SHUT_WITHIN = 150
"""So often is looked whether who has the bench has shut a laser that was disarmed."""
LOOKS = 10
"""Between so many of these is looked whether an arming is over."""
OBEYS = 0.02
"""Seconds of wall time between two looks at whether somebody asked to stop."""
ADOPTING = "adopting"
"""For which the bench is taken while it gets another Lab: one that can't be read is no reason not to."""
LEASE_OVER = "its lease was over: the coordinator was away, or gave the bench away"
HALTED = error("halted", "the bench is halted: nothing more is started")


class LocalEdge:
    """The bench at `place`, with its device. It dies with this process, as a killed run does.

    `opening` opens the device of a setup; `lab` is what `setup` was read from, which the bench keeps as its own from
    the first time that it is taken (None: on trial, nothing is kept). `clock` gives the wall time as ISO 8601, UTC.
    `settled`: what had begun and was found out about when the bench was taken last.
    """

    def __init__(
        self, setup: Setup, place: BenchPlace, opening: Callable[[Setup], Device], lab: OwnLab | None = None,
        clock: Callable[[], str] = utc_now,
    ) -> None:  # fmt: skip
        self.setup, self.place, self.device = setup, place, opening(setup)
        self._opening, self._kept = opening, KeptLab(place, lab, clock)
        self._usual: tuple[Setup, Device] | None = None
        self.settled: tuple[SettledOperation, ...] = ()
        self._lock, self.now = BenchLock(place, clock), clock
        self._lasers: Shutting | None = None
        self._releasing = asyncio.Lock()
        self._minded = frozenset[tuple[str, str]]()
        self._able: tuple[Device, Capabilities] | None = None
        self._lease: Lease | None = None
        self._halted = False
        self._ended_for = ""  # why what is under way was ended by somebody else than its client
        self._stopping: Stopping = ""
        self._attempts: Attempts | None = None
        self._steering: Teleoperating | None = None
        self._under_way: dict[str, asyncio.Task[OperationResult]] = {}
        self._runs = StartedRuns()
        self._running: Running | None = None
        self._open: OpenRun | None = None
        self._obeying: asyncio.Task[None] | None = None
        self._alone: Alone | None = None
        self._remembers = Remembering(place, clock)
        self._listeners: list[Callable[[Event], None]] = []
        self._seen: Observation | None = None

    async def describe(self) -> Capabilities:
        """Return what the device can do, at the speed of the run that goes on."""
        from pico.teleop.frames import STEPS

        able = await self.device.describe()
        whole = {"set", "measure"} <= able.primitives
        primitives = able.primitives | ({"optimize", "verify", "survey"} if whole else set())
        if able.primitives >= STEPS:
            primitives = primitives - STEPS | {"teleoperate"}
        return replace(able, primitives=primitives, kept=self.device.kept())

    def served(self) -> None:
        """From now on who has the bench has it through this process, which serves it."""
        self._lock.server = True

    def granted_by(self, granting: Granting) -> None:
        """From now on the bench is taken under leases of the coordinator that it is enrolled with, and of no other."""
        self._lock.granting, self._lock.server = granting, True

    @property
    def enrolled(self) -> bool:
        """Whether a coordinator grants this bench."""
        return self._lock.granting is not None

    def last_token(self) -> int:
        """Return the highest token that this bench gave out itself; raises PicoError."""
        return self._lock.last_token()

    def _require(self, *, under_way: bool = False) -> None:
        """Raise PicoError (exit code INTERRUPTED) where the coordinator's lease is over."""
        if self._lock.granting is not None:
            self._lock.granting.require(under_way=under_way)

    def _stops(self) -> Stopping:
        """Return whether what goes on in steps is to stop, and how: it is asked to, or the lease is over."""
        if not self._stopping:
            try:
                self._require(under_way=True)
            except PicoError:
                return "safely"
        return self._stopping

    async def holder(self) -> Holder | None:
        """Return who moves the bench, None where nobody does."""
        return self._lock.holder()

    async def unended(self) -> str | None:
        """Return the run that has begun and not ended, None for none."""
        return self._remembers.unended()

    async def lab(self) -> OwnLab | None:
        """Return the Lab of the bench; None on trial."""
        return self._kept.lab

    async def adopt(self, lab: OwnLab, holder: str) -> None:
        """Take another Lab as the bench's own; see `pico.edge.protocol.Edge`."""
        setup = own_lab.setup_of(lab)
        await self._acquire(holder, 0.0, ADOPTING)
        try:
            await self._require_hands(setup)
            self._kept.keep(lab, holder)
        finally:
            await self._leave()
        self.setup, self.device = setup, self._opening(setup)

    async def _require_hands(self, setup: Setup) -> None:
        for name, robot in (await self.observe()).robots.items():
            if robot.holding and (robot.holding not in setup.lab.inventory or name not in setup.lab.robots):
                text = f"{name} holds {robot.holding}, and the Lab to be adopted does not have both"
                raise PicoError(error("held", text, hint="`pico recover` sets it down"))

    # looking

    async def observe(self) -> Observation:
        """Look, and return what was seen; raises PicoError where nothing can be seen."""
        self._require_kept()
        self._seen = await self._with_licences(self._with_hands(await self.device.observe()))
        return self._seen

    async def moment(self) -> Moment:
        """Return the bench as it is now, as far as that is known without looking; raises PicoError."""
        from pico.twin.moment import moment_of

        if isinstance(self.device, Shown):
            return await self.device.moment()
        return moment_of(self._seen or Observation(backend=(await self.describe()).name))

    def listen(self, listener: Callable[[Event], None]) -> Callable[[], None]:
        """Have somebody told from now on what happens in runs; return what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    async def look(self) -> Look:
        """Look through the cameras and return what they see; raises PicoError where there are none."""
        self._require_kept()
        found = await self.device.look()
        return replace(found, observation=await self._with_licences(self._with_hands(found.observation)))

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, without lease; raises PicoError."""
        self._require_kept()
        return await self.device.peek(component, measurable)

    def _with_hands(self, seen: Observation) -> Observation:
        """Return the observation with what the journal knows of the parts in the hands: where they were picked."""
        if not any(robot.holding or robot.opening is not None for robot in seen.robots.values()):
            return seen
        from pico.edge.grip import with_picks

        with suppress(PicoError):  # looking must not fail because of the journal
            return with_picks(self.setup, self.memory, seen) if self.memory else seen
        return seen

    async def _with_licences(self, seen: Observation) -> Observation:
        from pico.edge.emission import with_licences

        if self._able is None or self._able[0] is not self.device:
            self._able = self.device, await self.device.describe()
        return await with_licences(self.setup, self.place, self._able[1], self.device, self.now(), seen)

    # who may let it emit

    async def armings(self) -> tuple[Kept, ...]:
        """Return what the bench keeps of armings, broken ones, too."""
        from pico.edge.armings import kept

        return kept(self.place)

    async def arm(self, arming: Arming) -> Arming:
        """Keep an arming, see `pico.edge.protocol.Edge`."""
        from pico.edge.armings import keep
        from pico.edge.emission import require_commissioned
        from pico.policy.arming import refusal

        require_attached(self.place)
        given = replace(arming, backend=(await self.device.describe()).name)
        if wrong := refusal(self.setup, given, self.now()):
            raise PicoError(wrong, ExitCode.DENIED)
        await require_commissioned(self.setup, self.place, self.device, self.now(), given)
        keep(self.place, given)
        return given

    async def disarm(self, laser: str, by: str) -> bool:
        """End what arms a laser, and shut it; see `pico.edge.protocol.Edge`."""
        from pico.edge.armings import keep
        from pico.policy.arming import ended

        require_attached(self.place)
        now, known = self.now(), {one.laser: one.arming for one in await self.armings()}
        keep(self.place, ended(self.setup, known.get(laser), laser, by, (await self.device.describe()).name, now))
        for _ in range(SHUT_WITHIN):
            if self._lease is None and await self.holder() is None:
                with suppress(PicoError):  # who takes the bench next shuts it, or has it and does
                    await self.release(await self.acquire("pico laser disarm"))
            if laser not in {one.laser for one in await self.armings()}:
                return True
            await asyncio.sleep(OBEYS)
        return False

    # where nobody is there

    @property
    def alone(self) -> Alone:
        """What holds an unattended run to its terms."""
        from pico.edge.unattended import Alone

        if self._alone is None:
            self._alone = Alone(self)
        return self._alone

    async def hold(self, terms: Terms) -> Left | None:
        """Hold an unattended run to its terms; see `pico.edge.protocol.Edge`."""
        require_attached(self.place)
        return await self.alone.hold(terms)

    async def goes_on(self, recipe: str) -> None:
        """Hear that the client of an unattended run goes on."""
        self.alone.goes_on(recipe)

    async def leave(self, recipe: str, moves: bool) -> Left:
        """Bring about the end state of an unattended run; see `pico.edge.protocol.Edge`."""
        return await self.alone.leave(recipe, moves=moves)

    async def unattended(self) -> Terms | None:
        """Return the terms of an unattended run; see `pico.edge.protocol.Edge`."""
        known = self._alone is not None or (self.place.folder / UNATTENDED).exists()
        return self.alone.known() if known else None

    def moving(self) -> bool:
        """Return whether something is under way."""
        return self._running is not None or bool(self._under_way)

    async def end_of(self, holder: str) -> None:
        """Bring what a holder has under way to its safe end, and take the bench back from it."""
        if self._lease is not None and self._lease.holder == holder:
            await self.drain()

    async def drain(self) -> None:
        """Bring what is under way to its safe end, and take the bench back from whoever has it."""
        if (lease := self._lease) is not None:
            self._ended_for = self._ended_for or LEASE_OVER
            await self._halt()
            await self._ended()
            await self.release(lease)

    async def _shut_over(self, seen: Observation | None = None) -> None:
        """See `pico.edge.shutting.Shutting.shut_over`; nothing is shut here while nobody has the bench."""
        if self._attempts is None:
            return
        if self._lasers is None:
            from pico.edge.shutting import Shutting

            self._lasers = Shutting(self)
        await self._lasers.shut_over(seen)

    def run_under_way(self) -> str | None:
        """Return the run that an operation belongs to now, None where none goes on."""
        under_way = self._open or self._running
        return under_way.id if under_way is not None else None

    def goes_on_with(self, run: str) -> bool:
        """Return whether a run that was started here goes on."""
        task = self._runs[run].task if self._runs.knows(run) else None
        return task is not None and not task.done()

    def arming_over(self) -> bool:
        """Return whether an arming has ended since this was asked last, while nobody has the bench."""
        from pico.edge import emission

        over = frozenset(emission.over(self.setup, self.place, self.now()).items())
        if self._lease is not None or over <= self._minded:
            return False
        self._minded = over
        return True

    # who may move it

    async def acquire(self, holder: str, wait: float = 0.0) -> Lease:
        """Take the bench; raises PicoError (exit code LOCKED) where somebody has it, and where its files are broken."""
        return await self._acquire(holder, wait)

    async def _acquire(
        self, holder: str, wait: float, run: str = "", prepare: Callable[[], None] = lambda: None
    ) -> Lease:  # fmt: skip
        """Take the bench for a run, or for who runs nothing; `prepare` is called before the device is taken."""
        from pico.edge.aligning import Aligning
        from pico.edge.attempts import Attempts
        from pico.edge.emission import Guarded
        from pico.edge.recovery import open_questions, settle
        from pico.edge.surveying import Surveying
        from pico.edge.teleoperating import Teleoperating
        from pico.execution.conditions import Conditioned

        self._halted &= self._lease is not None  # what is halted stays so for who has the bench
        own = self._lease is None
        lease = await self._lock.acquire_within(
            holder, wait, lambda: run in self._runs.cancelled or (own and self._halted)
        )
        self._halted, self._stopping, self._ended_for = False, "", ""
        try:
            self._require_kept()
            try:
                self._kept.require(holder)
            except PicoError as exc:
                if run != ADOPTING or exc.diagnostics[0].code != own_lab.CODE:
                    raise
            prepare()
            await self.device.take(lease.token, self._heard, lambda: self._require(under_way=True))
            aligning = Aligning(self.setup, self.place, self.device, self._stops, self._heard)
            surveying = Surveying(self.setup, aligning, self.device, self._stops, self._heard)
            doing = Teleoperating(self.setup, surveying, self.device, self._stops, self._heard)
            self._steering = doing
            guarded = Guarded(self.setup, doing, self.observe, lambda: self._running is None, self.alone.most)
            counting = self._counting(guarded)
            conditioned = Conditioned(self.setup, counting, self.observe)
            self._attempts, self._lease = Attempts(self.journal, conditioned, lease.token, self._require), lease
            seen = await self.observe()
            self.settled = settle(self.setup, self.journal, seen, lease.token)
            if asked := open_questions(self.journal.unsettled()):
                raise PicoError(asked)
            if not run:
                await self._shut_over(seen)
        except BaseException:
            await self._leave()
            raise
        self._obeying = asyncio.create_task(self._obey(lease, idle=not run))
        return lease

    def _counting(self, inner: Executing) -> Executing:
        """Return what does the same, and counts the light on samples where there are any."""
        if not any(part.sample for part in self.setup.lab.inventory.values()):
            return inner
        from pico.edge.dose import Dosing

        return Dosing(self.setup, self.place, inner, self.observe)

    async def doses(self) -> tuple[Dose, ...]:
        """Return what the samples of the bench had; see `pico.edge.protocol.Edge`."""
        return self._doses(await self.observe()) if self._has_samples() else ()

    def _has_samples(self) -> bool:
        return any(part.sample for part in self.setup.lab.inventory.values())

    def _doses(self, seen: Observation) -> tuple[Dose, ...]:
        """Return what the samples of the bench had until it was seen so."""
        if not self._has_samples():
            return ()
        from pico.edge.dose import read

        return read(self.place).until(self.setup, seen).doses(self.setup)

    async def release(self, lease: Lease) -> None:
        """Give the bench back, once everything under way has ended."""
        async with self._releasing:
            if self._lease is not None and lease.token == self._lease.token:
                await self._leave()

    async def _leave(self) -> None:
        if self._open is not None:
            if self._running is not None:
                await self.halt()
            await self._ended()
        while self._under_way:
            await asyncio.wait(list(self._under_way.values()))
        with suppress(PicoError):  # a journal that is gone must not keep the bench from others
            self._end_open("interrupted")
        if self._obeying is not None:
            self._obeying.cancel()
        await self.device.leave()
        if self._usual is not None:
            (self.setup, self.device), self._usual = self._usual, None
        self._lease = self._attempts = self._obeying = self._steering = None
        self._lock.release()

    async def _obey(self, lease: Lease, *, idle: bool) -> None:
        """Look all the time whether somebody asks at another terminal to stop, and do so; who only has the bench and
        runs nothing (`idle`) then loses it, at a safe end."""
        from pico.edge.stopping import asked_to_stop

        last: Asking | None = None
        for turn in count():
            if turn % LOOKS == LOOKS - 1 and (idle or self._open is not None or self._running is not None):
                with suppress(PicoError):  # a journal that is gone is told by what moves
                    await self._shut_over()
            asked = asked_to_stop(self.place, lease.token)
            if asked is not None and asked != last:
                last = asked
                await (self.stop() if asked == "now" else self.halt())
                if idle or self._open is not None:
                    self._obeying = None  # this task goes on to the end
                    await self.release(lease)
                    return
            await asyncio.sleep(OBEYS)

    # moving

    async def execute(self, operation: Operation, key: str, lease: Lease, *, tidies: bool = False) -> OperationResult:
        """Execute one operation, once for each key; cancelling the wait does not cancel the motion.

        Raises PicoError: exit code LOCKED without the current lease, INTERRUPTED on a halted bench, ERROR for a known
        key with other content or a journal that can't be written.
        `tidies`: it sets back what was set only to measure, which a bench does that is halted safely, too.
        """
        if self._lease is None or lease.token != self._lease.token:
            text = f"the lease {lease.token} of {lease.holder} is not the current one"
            raise PicoError(error("lease", text), ExitCode.LOCKED)
        if self._halted and not (tidies and self._stopping == "safely"):
            raise PicoError(HALTED, ExitCode.INTERRUPTED)
        return await self.perform(operation, key)

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        """Have an operation done by who has the bench, once for each key; cancelling the wait does not cancel it."""
        attempts = self._attempts
        if attempts is None:
            raise PicoError(error("lease", "nobody has the bench any more"), ExitCode.LOCKED)
        if key not in self._under_way:
            known = attempts.known(operation, key)
            if known is not None:
                return known
            task = self._under_way[key] = asyncio.create_task(attempts.perform(operation, key))
            task.add_done_callback(lambda _: self._under_way.pop(key, None))
        return await asyncio.shield(self._under_way[key])

    async def start(self, job: Job, run: str) -> str:
        """Check a plan again, and start a run of it; see `pico.edge.protocol.Edge`."""
        if not job.resumes and self._runs.is_known(run, job.plan.digest):
            return run
        self._runs.cancelled.discard(run)  # of an earlier time that it was taken up
        running = self._new(job, run)
        lease = self._step_of(job) if job.within else await self._taken(job, running)
        try:
            seen, able = await self._permitted(job.plan)
            await self._shut_over(seen)
            if not job.within:
                self._begin(job, run, able, lease)
        except BaseException:
            if not job.within:
                await self._leave()
            raise
        self._runs.add(running)
        self._running = running
        self._halted |= run in self._runs.cancelled
        running.task = asyncio.create_task(self._carry_out(job, running, lease, seen.time))
        running.task.add_done_callback(running.over)
        return run

    async def _taken(self, job: Job, running: Running) -> Lease:
        """Take the bench for a run, at its speed; raises PicoError where its plan is not for this bench."""
        from pico.policy.judging.case import PlanCase
        from pico.policy.judging.judges import require_permitted

        if self._alone is not None:
            self._alone.goes_on(job.holder.removeprefix(f"{RECIPE} "))
        usual, _ = self._usual or (self.setup, None)
        able = replace(await self.describe(), lab_digest=usual.at_speed(job.speed).digest())
        require_permitted(PlanCase(self.setup, job.plan, able=able))

        def prepare() -> None:
            if (setup := self.setup.at_speed(job.speed)) != self.setup:
                self._usual = self.setup, self.device
                self.setup, self.device = setup, self._opening(setup)
            self.device.watch(running.recording.look if running.recording else None)

        return await self._acquire(job.holder, job.wait, running.id, prepare)

    async def _permitted(self, plan: Plan) -> tuple[Observation, Capabilities]:
        """Return the bench as it is and what it can do, once all judges have let a plan pass; raises PicoError."""
        from pico.policy.judging.case import PlanCase
        from pico.policy.judging.judges import require_permitted

        able, seen = await self.describe(), await self.observe()
        doses = self._doses(seen) if plan.operations else ()
        require_permitted(PlanCase(self.setup, plan, seen, able, doses))
        return seen, able

    def _step_of(self, job: Job) -> Lease:
        """Return the lease of the open run that a job is a step of; raises PicoError where that can't begin now."""
        from pico.edge.open_run import not_open

        if self._open is None or self._lease is None or self._open.id != job.within:
            raise PicoError(not_open(str(job.within)), ExitCode.INTERRUPTED)
        if self._halted:
            raise PicoError(HALTED, ExitCode.INTERRUPTED)
        if self._running is not None:
            text = f"a step of run {job.within} is under way"
            raise PicoError(error("run", text, hint="what runs side by side is one plan, such as of several `set`"))
        if job.filmed or job.resumes:
            text = "a step of an open run is neither filmed nor taken up by itself"
            raise PicoError(error("run", text, hint="run it outside of it"))
        return self._lease

    async def open(self, job: Job, run: str) -> Lease:
        """Take the bench and begin a run that stays open; see `pico.edge.protocol.Edge`."""
        from pico.edge.open_run import OpenRun

        lease = await self._taken(job, self._new(job, run))
        try:
            seen, able = await self._permitted(job.plan)
            await self._shut_over(seen)
            self._begin(job, run, able, lease)
        except BaseException:
            await self._leave()
            raise
        self._open = OpenRun(run, job.plan)
        return lease

    async def finish(self, run: str, outcome: RunOutcome) -> RunReport:
        """End an open run and give the bench back; see `pico.edge.protocol.Edge`."""
        from pico.edge.about import seen_after
        from pico.edge.open_run import not_open

        opened = self._open
        if opened is None or opened.id != run:
            raise PicoError(not_open(run), ExitCode.INTERRUPTED)
        await self._ended()
        try:
            seen, able = await self.observe(), await self.describe()
            report = opened.report("interrupted" if self._halted else outcome, seen, able)
            report = replace(report, diagnostics=self._told())
            self._end_open(report.outcome)
            self.journal.saw(run, seen_after(seen, (), reached=False))
        finally:
            await self._leave()
        return report

    def _end_open(self, outcome: RunOutcome) -> None:
        """Write down how the open run ended."""
        opened, self._open = self._open, None
        if opened is not None:
            self._remembers.end(opened.id, outcome, opened.counts())

    def _new(self, job: Job, run: str) -> Running:
        from pico.edge.running import Running
        from pico.twin.snapshot import Recording

        return Running(run, job.plan.digest, Recording() if job.filmed else None)

    def _begin(self, job: Job, run: str, able: Capabilities, lease: Lease) -> None:
        from pico.edge.about import about_run

        about = about_run(self.setup, job.plan, able)
        if job.resumes:
            self.journal.resume_run(run, about)
        else:
            plan = job.plan
            self.journal.begin_run(run, plan.digest, lease.holder, document=plan.to_json(), about=about)
        self._remembers.begun(run)

    async def _carry_out(self, job: Job, running: Running, lease: Lease, now: float) -> RunReport:
        """Walk a plan to its end, whoever listens, and return what became of it."""
        from pico.execution.walk import Walk

        async def execute(operation: Operation, key: str) -> OperationResult:
            if walk.sets_back(operation):
                return await self.execute(operation, key, lease, tidies=True)
            return await self.execute(operation, key, lease)

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
            self._runs.cancelled.discard(running.id)
            if around is None:
                await self.release(lease)

    def _tell(self, running: Running, event: Event) -> None:
        """Write down how a run ended before anyone hears of it, and log what happens."""
        try:
            if event.kind == "run_finished" and self._open is not None:
                self._open.count(event)
            elif event.kind == "run_finished":
                tally = {k: v for k, v in event.data.items() if k != "outcome"}
                self._remembers.end(running.id, event.data["outcome"], tally)
        finally:  # a journal that is gone must not hide what became of the run
            running.tell(event)
            for listener in tuple(self._listeners):
                listener(event)

    async def _reported(self, job: Job, running: Running, wall: float) -> RunReport:
        """Look at the bench after a run, write down how it stands, and return what became of the run.

        Raises PicoError where nothing can be seen any more, with what went wrong before.
        """
        from pico.edge.about import seen_after
        from pico.execution.report import measured, run_report, told_by

        able = await self.describe()
        events = [e for e in running.log if e.kind != "operation_progress"]
        try:
            seen = replace(await self.observe(), measurements=measured(job.plan, events))
        except PicoError as exc:
            raise PicoError([*told_by(events), *exc.diagnostics], exc.exit_code) from exc
        report = run_report(self.setup, job.plan, events, seen, wall=wall, able=able)
        reached = report.whole and report.outcome == "done" and report.reached and not report.by_light
        report = replace(
            report, diagnostics=(*report.diagnostics, *self._kept.told(), *self._told(), *self._why(report))
        )
        if self._open is not None:
            return report
        try:
            self.journal.saw(running.id, seen_after(seen, report.expectations, reached=reached))
        except PicoError as exc:  # it must not hide the report
            return replace(report, diagnostics=(*report.diagnostics, *exc.diagnostics))
        return report

    def _heard(self, event: Event) -> None:
        if self._running is not None and self._running.walk is not None:
            self._running.walk.heard(event)

    def _told(self) -> tuple[Diagnostic, ...]:
        """Return, once, which lasers were shut, and why."""
        return self._lasers.told() if self._lasers is not None else ()

    async def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        """Yield what happened in a run after its event `since`, and what happens."""
        async for event in self._runs[run].events(since):
            yield event

    async def report(self, run: str) -> RunReport:
        """Wait for the end of a run, and return what became of it; raises PicoError for what cut it short."""
        task = self._runs[run].task
        assert task is not None  # it is known from then on
        return await asyncio.shield(task)

    async def film(self, run: str) -> list[Snapshot]:
        """Return what a film of a run shows; empty where it was not filmed."""
        recording = self._runs[run].recording
        return recording.snapshots if recording else []

    async def jog(self, run: str, frame: Frame) -> Answer:
        """Say what a hand on a key says to the teleoperation in a run; see `pico.edge.protocol.Edge`."""
        from pico.teleop.frames import over

        self._runs[run]
        if self._steering is None or self._running is None or self._running.id != run:
            return over(time.monotonic())
        return self._steering.hear(frame)

    async def cancel(self, run: str) -> None:
        """Start nothing more of a run, and bring everything to a safe end."""
        self._runs.cancelled.add(run)
        if self._running is not None and self._running.id == run:
            await self._halt()

    async def halt(self) -> None:
        """Start nothing more, and wait until what is under way has reached a safe end."""
        self._stopped_for()
        await self._halt()

    async def _halt(self) -> None:
        self._interrupt()
        await self.device.halt()

    def _stopped_for(self) -> None:
        if who := from_afar():
            self._ended_for = self._ended_for or f"{who} stopped it"

    async def stop(self) -> None:
        """Stop everything where it is; grippers hold what they hold. Nothing starts until the bench is taken anew."""
        self._stopped_for()
        self._interrupt()
        self._stopping = "now"
        await self.device.stop()

    def _interrupt(self) -> None:
        self._halted, self._stopping = True, self._stopping or "safely"
        if self._running is not None and self._running.walk is not None:
            self._running.walk.interrupt()

    def _why(self, report: RunReport) -> tuple[Diagnostic, ...]:
        """Return why a run was interrupted, where its client does not know."""
        if report.outcome != "interrupted":
            return ()
        why, granting = self._ended_for, self._lock.granting
        if not why and granting is not None:
            try:
                granting.require()
            except PicoError:  # a step asked that before anybody drained the bench
                why = LEASE_OVER
        return (warning("ended", why),) if why else ()

    # remembering

    @property
    def journal(self) -> Journal:
        """The journal of the bench, opened when it is first needed; raises PicoError."""
        return self._remembers.journal

    @property
    def memory(self) -> Journal | None:
        """What the bench remembers of its runs, to be read from any disk and thread; None where there was none yet."""
        return self._remembers.memory

    async def resolve(self, key: str, outcome: Outcome, by: str) -> None:
        """Record what a person says of an operation that only a person can tell the end of; raises PicoError."""
        with self._lock.held("pico recover") as lease:
            self.journal.fence(lease.token)
            asked = {open.key for open in self.journal.unsettled()}
            if key not in asked:
                known = ", ".join(sorted(asked)) or "nothing is open"
                raise PicoError(error("unknown-key", f"nobody asks about {key[:80]}", hint=f"open: {known}"))
            self.journal.resolve(key, outcome, by, None, lease.token)

    # simulating

    @property
    def world(self) -> World:
        """The simulated world, which is locked for each change; raises PicoError where nothing is simulated."""
        return self.device.world(self._lock.held, self._require_kept)

    def _require_kept(self) -> None:
        """Raise PicoError where a simulated world is gone, and the journal says that it was moved."""
        if not self.device.kept() and self._remembers.path.exists():
            from pico.edge.recovery import require_unmoved

            require_unmoved(self._remembers.path)

    async def _ended(self) -> None:
        if self._running is not None and self._running.task is not None:
            await asyncio.wait([self._running.task])

    async def close(self) -> None:
        """Bring what is under way to its safe end, give the bench back, let go of the journal."""
        if self._alone is not None:
            await self._alone.close()
        self._interrupt()
        await self._ended()
        if self._lease is not None:
            await self._leave()
        await self.device.close()
        self._remembers.close()


def embedded(
    setup: Setup, place: BenchPlace, fidelity: str, lab: OwnLab | None = None,
    clock: Callable[[], str] = utc_now,
) -> LocalEdge:  # fmt: skip
    """Return the edge in this process of the bench at `place`, see `LocalEdge`; raises PicoError for what
    there is not."""
    opening = opener(place.name)
    return LocalEdge(setup, place, lambda setup: opening(setup, place, fidelity, clock), lab, clock)
