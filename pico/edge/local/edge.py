"""The edge in this process: composes a device with the lock, the journal, execution and policy of one bench."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING

from pico.backends.device import Capabilities, Device, LightGuarded
from pico.backends.devices import opener
from pico.backends.world import World
from pico.base.clock import now as clock_now
from pico.diagnostics import PicoError, error
from pico.edge import own_lab
from pico.edge.contract import Edge
from pico.edge.kept_lab import KeptLab
from pico.edge.lease import BenchLock
from pico.edge.local.apparatus import Apparatus
from pico.edge.local.custody import ADOPTING, Custody
from pico.edge.local.licensing import Licensing
from pico.edge.local.runs import Runs
from pico.edge.local.sight import Sight
from pico.edge.protocol import Granting, Holder, Job, Lease, OwnLab
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.places.bench import BenchPlace
from pico.places.lab import lenient

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.hardware.guard.verdict import Trip
    from pico.backends.sight import Look
    from pico.edge.armings import Kept
    from pico.edge.unattended import Alone
    from pico.model.arming import Arming
    from pico.model.trace.dose import Dose
    from pico.model.trace.report import RunReport
    from pico.model.trace.run import RunOutcome
    from pico.model.trace.unattended import Left, Terms
    from pico.runs.journal import Journal
    from pico.teleop.frames import Answer, Frame
    from pico.twin.snapshot import Snapshot


OWN_HOLDERS = frozenset({"pico laser disarm"})
ENDS = "the end of "
"""For what an edge takes the bench by itself, to end light and to leave the bench safe: no lock keeps it from that."""


class LocalEdge(Edge):
    """The bench at `place`, with its device. It dies with this process, as a killed run does.

    `opening` opens the device of a setup; `lab` is what `setup` was read from, which the bench keeps as its own from
    the first time that it is taken (None: on trial, nothing is kept). `clock` gives the wall time as ISO 8601, UTC.
    What it does stands in its parts (`pico.edge.local`), each of which is handed those that it needs; `Edge` says what
    the methods return and raise.
    """

    def __init__(
        self, setup: Setup, place: BenchPlace, opening: Callable[[Setup], Device], lab: OwnLab | None = None,
        clock: Callable[[], str] = clock_now,
    ) -> None:  # fmt: skip
        self._kept, self.lock = KeptLab(place, lab, clock), BenchLock(place, clock)
        self.apparatus = Apparatus(setup, place, opening, clock, lab.as_bytes() if lab is not None else None)
        self.sight = Sight(self.apparatus)
        self.licensing = Licensing(self.apparatus, self.sight, self)
        self.custody = Custody(self.apparatus, self.sight, self.licensing, self.lock, self._kept)
        self.runs = Runs(self.apparatus, self.sight, self.licensing, self.custody, self._kept)
        self.custody.tenant = self.runs
        self.apparatus.listen(self._light_ended, self._disarm)

    def _light_ended(self, ended: Ended, trip: Trip | None) -> None:
        """Write into the journal that light was ended beside a run; called in any thread."""
        from pico.edge.guard.journaling import record_ended

        lease = self.custody.lease
        try:
            token = lease.token if lease is not None else self.lock.last_token()
        except PicoError:  # light is ended, whatever lies in the place of the lock
            return
        own = self.apparatus
        record_ended(own.setup, own.device, own.journals.path, ended, self.run_under_way(), token)

    def _disarm(self, by: str) -> tuple[str, ...]:
        """End what arms lasers above class 2, and return of which; called in any thread."""
        from pico.edge.emission import disarm_all

        own = self.apparatus
        return disarm_all(own.setup, own.place, by, own.now())

    # the bench

    @property
    def setup(self) -> Setup:
        """The bench as it is now, at the speed of the run in progress."""
        return self.apparatus.setup

    @property
    def place(self) -> BenchPlace:
        """Where the files of the bench lie."""
        return self.apparatus.place

    @property
    def device(self) -> Device:
        """What moves and looks."""
        return self.apparatus.device

    @property
    def world(self) -> World:
        return self.device.world(self.lock.held, self.apparatus.require_kept)

    @property
    def journal(self) -> Journal:
        """The journal of the bench, opened when it is first needed; raises PicoError."""
        return self.apparatus.journals.journal

    @property
    def memory(self) -> Journal | None:
        return self.apparatus.journals.memory

    def now(self) -> str:
        """Return the wall time as ISO 8601, UTC."""
        return self.apparatus.now()

    def granted_by(self, granting: Granting) -> None:
        """From now on the bench is taken under leases of the coordinator that it is enrolled with, and of no other."""
        self.lock.granting, self.lock.server = granting, True

    @property
    def enrolled(self) -> bool:
        """Whether a coordinator grants this bench."""
        return self.lock.granting is not None

    async def lab(self) -> OwnLab | None:
        return self._kept.lab

    async def adopt(self, lab: OwnLab, holder: str) -> None:
        """Take another Lab as the bench's own."""
        setup = own_lab.setup_of(lab)
        await self.custody.take(holder, 0.0, ADOPTING)
        try:
            await self._require_hands(setup)
            self._kept.keep(lab, holder)
        finally:
            await self.custody.leave()
        self.apparatus.become(setup, lab.as_bytes())

    async def _require_hands(self, setup: Setup) -> None:
        for name, robot in (await self.observe()).robots.items():
            if robot.holding and (robot.holding not in setup.lab.inventory or name not in setup.lab.robots):
                text = f"{name} holds {robot.holding}, and the Lab to be adopted does not have both"
                raise PicoError(error("held", text, hint="`pico recover` sets it down"))

    async def resolve(self, key: str, outcome: Outcome, by: str) -> None:
        with self.lock.held("pico recover") as lease:
            self.journal.fence(lease.token)
            asked = {open.key for open in self.journal.unsettled()}
            if key not in asked:
                known = ", ".join(sorted(asked)) or "nothing is open"
                raise PicoError(error("unknown-key", f"nobody asks about {key[:80]}", hint=f"open: {known}"))
            self.journal.resolve(key, outcome, by, None, lease.token)

    async def close(self) -> None:
        await self.licensing.close()
        self.custody.interrupt()
        await self.runs.ended()
        if self.custody.lease is not None:
            await self.custody.leave()
        await self.device.close()
        self.apparatus.journals.close()

    # sight

    async def describe(self) -> Capabilities:
        return await self.apparatus.describe()

    async def observe(self) -> Observation:
        return await self.sight.observe()

    async def look(self) -> Look:
        return await self.sight.look()

    async def peek(self, component: str, measurable: str) -> Measurement:
        return await self.sight.peek(component, measurable)

    async def faults(self) -> tuple[DeviceFault, ...]:
        return await self.sight.faults()

    # licensing

    async def armings(self) -> tuple[Kept, ...]:
        return await self.licensing.armings()

    async def arm(self, arming: Arming) -> Arming:
        return await self.licensing.arm(arming)

    async def disarm(self, laser: str, by: str) -> bool:
        with lenient():
            return await self.licensing.disarm(laser, by)

    async def doses(self) -> tuple[Dose, ...]:
        return await self.licensing.doses()

    @property
    def alone(self) -> Alone:
        """What holds an unattended run to its terms."""
        return self.licensing.alone

    async def hold(self, terms: Terms) -> Left | None:
        return await self.licensing.hold(terms)

    async def goes_on(self, recipe: str) -> None:
        self.alone.goes_on(recipe)

    async def leave(self, recipe: str, moves: bool) -> Left:
        return await self.alone.leave(recipe, moves=moves)

    async def unattended(self) -> Terms | None:
        return await self.licensing.unattended()

    # custody

    @property
    def lease(self) -> Lease | None:
        """The lease of who has the bench through this edge."""
        return self.custody.lease

    async def holder(self) -> Holder | None:
        return self.lock.holder()

    async def acquire(self, holder: str, wait: float = 0.0) -> Lease:
        if holder not in OWN_HOLDERS and not holder.startswith(ENDS):
            from pico.edge.guard.table_lock import require

            require(self.place, alone=self.alone.goes)
        return await self.custody.take(holder, wait)

    async def release(self, lease: Lease) -> None:
        await self.custody.release(lease)

    async def execute(self, operation: Operation, key: str, lease: Lease, *, tidies: bool = False) -> OperationResult:
        """Execute one operation, once for each key; cancelling the wait does not cancel the motion.

        Raises PicoError: exit code LOCKED without the current lease, INTERRUPTED on a halted bench, ERROR for a known
        key with other content or a journal that can't be written.
        `tidies`: it sets back what was set only to measure, which a bench does that is halted safely, too.
        """
        return await self.custody.execute(operation, key, lease, tidies=tidies)

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        """Have an operation done by who has the bench, once for each key; cancelling the wait does not cancel it."""
        return await self.custody.perform(operation, key)

    async def clear_fault(self, device: str, by: str) -> None:
        await self.custody.clear_fault(device, by)

    async def halt(self) -> None:
        await self.custody.halt()

    async def stop(self) -> None:
        await self.custody.stop()

    async def end_light(self, *, at_end: bool = False) -> Ended | None:
        """End all light now, whoever has the bench, and return what became of each laser; None if nothing emits here.
        `at_end`: because the process ends that serves the bench.
        Raises PicoError if no device can be had at all."""
        device = self.apparatus.device
        with lenient():
            return await device.end_light(at_end=at_end) if isinstance(device, LightGuarded) else None

    def leaves_light(self) -> bool:
        """Return whether this process has the links of lasers of which one may emit: its guard ends with it."""
        device = self.apparatus.device
        return isinstance(device, LightGuarded) and device.may_emit()

    async def end_of(self, holder: str) -> None:
        """Bring what a holder has under way to its safe end, and take the bench back from it."""
        await self.custody.end_of(holder)

    def moving(self) -> bool:
        """Return whether something is under way."""
        return self.custody.is_moving

    # runs

    async def unended(self) -> str | None:
        return self.apparatus.journals.unended()

    def run_under_way(self) -> str | None:
        """Return the run that an operation belongs to now, None if no run is in progress."""
        return self.runs.under_way()

    async def start(self, job: Job, run: str) -> str:
        return await self.runs.start(job, run)

    async def open(self, job: Job, run: str) -> Lease:
        return await self.runs.open(job, run)

    async def finish(self, run: str, outcome: RunOutcome) -> RunReport:
        return await self.runs.finish(run, outcome)

    def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        return self.runs.started.events(run, since)

    async def report(self, run: str) -> RunReport:
        return await self.runs.started.report(run)

    async def film(self, run: str) -> list[Snapshot]:
        return self.runs.started.film(run)

    async def jog(self, run: str, frame: Frame) -> Answer:
        return self.runs.jog(run, frame)

    async def cancel(self, run: str) -> None:
        await self.runs.cancel(run)


def embedded(
    setup: Setup, place: BenchPlace, fidelity: str, lab: OwnLab | None = None,
    clock: Callable[[], str] = clock_now,
) -> LocalEdge:  # fmt: skip
    """Return the edge in this process of the bench at `place`, see `LocalEdge`; raises PicoError for what
    there is not."""
    opening = opener(place.name)
    return LocalEdge(setup, place, lambda setup: opening(setup, place, fidelity, clock), lab, clock)
