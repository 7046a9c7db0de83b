"""Who has the bench through an edge: its lease, the operations under way, and what stops them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import nullcontext, suppress
from itertools import count
from typing import TYPE_CHECKING, Protocol

from pico.base.state_files import TABLE_LOCK
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge import own_lab
from pico.edge.kept_lab import KeptLab
from pico.edge.lease import BenchLock, from_afar
from pico.edge.local.apparatus import Apparatus
from pico.edge.local.licensing import Licensing
from pico.edge.local.sight import Sight
from pico.edge.protocol import Lease
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult

if TYPE_CHECKING:
    from pico.edge.aligning import Stopping
    from pico.edge.attempts import Attempts
    from pico.edge.protocol import Asking
    from pico.edge.recovery import SettledOperation
    from pico.edge.teleoperating import Teleoperating
    from pico.execution.conditions import Conditioned
    from pico.model.trace.event import Event

LOOKS = 10
"""Between so many of these is looked whether an arming is over."""
OBEYS = 0.02
"""Seconds of wall time between two looks at whether somebody asked to stop."""
ADOPTING = "adopting"
"""For which the bench is taken while it gets another Lab: one that can't be read is no reason not to."""
LEASE_OVER = "its lease was over: the coordinator was away, or gave the bench away"
HALTED = error("halted", "the bench is halted: nothing more is started")


class Tenant(Protocol):
    """Work in progress under a lease, see `pico.edge.local.runs`."""

    @property
    def is_running(self) -> bool:
        """Whether a run, or a step of an open one, is under way."""
        ...

    @property
    def is_open(self) -> bool:
        """Whether an open run has the bench."""
        ...

    def is_cancelled(self, run: str) -> bool:
        """Return whether nothing more of a run may start."""
        ...

    def hear(self, event: Event) -> None:
        """Take what the device says of an operation."""
        ...

    def interrupt(self) -> None:
        """Start nothing more of the run under way."""
        ...

    async def ended(self) -> None:
        """Wait for the end of the run under way."""
        ...

    async def leave(self) -> None:
        """Bring a step of an open run to its end, for the bench is given back."""
        ...

    def end_open(self) -> None:
        """Write down that the open run was interrupted, if there is one."""
        ...


class Custody:
    """Takes one bench and gives it back, executes operations for who has it, and stops them.

    `tenant` is set once by who composes an edge: runs need custody of the bench, and custody ends runs. `settled`: what
    had begun and was found out about when the bench was taken last.
    """

    tenant: Tenant

    def __init__(
        self, apparatus: Apparatus, sight: Sight, licensing: Licensing, lock: BenchLock, kept: KeptLab
    ) -> None:
        self._apparatus, self._sight, self._licensing = apparatus, sight, licensing
        self._lock, self._kept = lock, kept
        self.lease: Lease | None = None
        self.halted = False
        self.settled: tuple[SettledOperation, ...] = ()
        self.steering: Teleoperating | None = None
        self._ended_for = ""  # why what is under way was ended by somebody else than its client
        self._stopping: Stopping = ""
        self._afar = ""  # for whom of a coordinator the bench is taken
        self._attempts: Attempts | None = None
        self._under_way: dict[str, asyncio.Task[OperationResult]] = {}
        self._releasing = asyncio.Lock()
        self._obeying: asyncio.Task[None] | None = None

    @property
    def is_moving(self) -> bool:
        """Whether a run or an operation is under way."""
        return self.tenant.is_running or bool(self._under_way)

    async def take(
        self, holder: str, wait: float, run: str = "", prepare: Callable[[], None] = lambda: None
    ) -> Lease:  # fmt: skip
        """Take the bench for a run, or for who runs nothing; `prepare` is called before the device is taken. Raises
        PicoError (exit code LOCKED) if somebody has it, and if its files are broken."""
        from pico.edge.attempts import Attempts
        from pico.edge.recovery import open_questions, settle

        self.halted &= self.lease is not None  # what is halted stays so for who has the bench
        own = self.lease is None
        lease = await self._lock.acquire_within(
            holder, wait, lambda: self.tenant.is_cancelled(run) or (own and self.halted)
        )
        self.halted, self._stopping, self._ended_for, self._afar = False, "", "", from_afar()
        try:
            self._apparatus.require_kept()
            try:
                self._kept.require(holder)
            except PicoError as exc:
                if run != ADOPTING or exc.diagnostics[0].code != own_lab.CODE:
                    raise
            prepare()
            bench = self._apparatus
            self._licensing.restore_terms()
            await bench.device.take(lease.token, self.tenant.hear, lambda: self._require(under_way=True))
            executing, journal = self._executing(), bench.journals.journal
            self._attempts, self.lease = Attempts(journal, executing, lease.token, self._require), lease
            seen = await self._sight.observe()
            self.settled = settle(bench.setup, journal, seen, lease.token)
            if asked := open_questions(journal.unsettled()):
                raise PicoError(asked)
            if not run:
                await self.shut_over(seen)
        except BaseException:
            await self.leave()
            raise
        self._obeying = asyncio.create_task(self._obey(lease, idle=not run))
        return lease

    def _executing(self) -> Conditioned:
        """Return what executes operations of every kind on the device, licensed and counted."""
        from pico.edge.aligning import Aligning
        from pico.edge.surveying import Surveying
        from pico.edge.teleoperating import Teleoperating
        from pico.execution.conditions import Conditioned

        own, hear = self._apparatus, self.tenant.hear
        aligning = Aligning(own.setup, own.place, own.device, self.stops, hear)
        surveying = Surveying(own.setup, aligning, own.device, self.stops, hear)
        self.steering = Teleoperating(own.setup, surveying, own.device, self.stops, hear)
        guarded = self._licensing.guard(self.steering, lambda: not self.tenant.is_running)
        return Conditioned(own.setup, guarded, self._sight.observe)

    async def release(self, lease: Lease) -> None:
        """Give the bench back, once everything under way has ended."""
        async with self._releasing:
            if self.lease is not None and lease.token == self.lease.token:
                await self.leave()

    async def leave(self) -> None:
        """Give the bench back, whoever has it."""
        await self.tenant.leave()
        while self._under_way:
            await asyncio.wait(list(self._under_way.values()))
        with suppress(PicoError):  # a journal that is gone must not keep the bench from others
            self.tenant.end_open()
        if self._obeying is not None:
            self._obeying.cancel()
        await self._apparatus.device.leave()
        self._apparatus.go_as_usual()
        self.lease = self._attempts = self._obeying = self.steering = None
        self._lock.release()

    async def shut_over(self, seen: Observation | None = None) -> None:
        """Shut lasers whose arming is over; does nothing while the bench is free."""
        if self._attempts is not None:
            await self._licensing.shut_over(seen)

    async def _obey(self, lease: Lease, *, idle: bool) -> None:
        """Look all the time whether somebody asks at another terminal to stop, and do so; who only has the bench and
        runs nothing (`idle`) then loses it, at a safe end."""
        from pico.edge.stopping import asked_to_stop

        last: Asking | None = None
        for turn in count():
            if turn % LOOKS == LOOKS - 1 and (idle or self.tenant.is_open or self.tenant.is_running):
                with suppress(PicoError):  # whatever moves reports a journal that is gone
                    await self.shut_over()
            if turn % LOOKS == 0 and not self.halted and (self._afar or self._licensing.alone.goes):
                await self._obey_table()
            asked = asked_to_stop(self._apparatus.place, lease.token)
            if asked is not None and asked != last:
                last = asked
                await (self.stop() if asked == "now" else self.halt())
                if idle or self.tenant.is_open:
                    self._obeying = None  # this task runs to its end
                    await self.release(lease)
                    return
            await asyncio.sleep(OBEYS)

    async def _obey_table(self) -> None:
        """Bring what goes on for somebody far away, or for nobody, to a safe end once a person locked the bench."""
        if TABLE_LOCK.path(self._apparatus.place.folder).exists():
            self._ended_for = self._ended_for or "a person at the table locked the bench"
            await self.halt_for_client()

    # operations

    async def execute(self, operation: Operation, key: str, lease: Lease, *, tidies: bool = False) -> OperationResult:
        """Execute one operation, once for each key; see `LocalEdge.execute`."""
        if self.lease is None or lease.token != self.lease.token:
            text = f"the lease {lease.token} of {lease.holder} is not the current one"
            raise PicoError(error("lease", text), ExitCode.LOCKED)
        if self.halted and not (tidies and self._stopping == "safely"):
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

    async def clear_fault(self, device: str, by: str) -> None:
        """Clear the faults of a device while nobody has the bench, see `EdgeCustody`."""
        from pico.backends.device import Clearable

        bench = self._apparatus.device
        if not isinstance(bench, Clearable):
            raise PicoError(error("unknown-device", "the devices of a simulated bench keep no faults"))
        if self.lease is not None:
            text = f"{self.lease.holder} has the bench: no fault is cleared meanwhile"
            raise PicoError(error("locked", text, hint="wait for its end, or end it: `pico stop`"), ExitCode.LOCKED)
        enrolled = self._lock.granting is not None  # then nobody else takes this lock, and clearing moves nothing
        with nullcontext() if enrolled else self._lock.held(f"pico recover ({by})"):
            await bench.clear(device)

    # stopping

    def _require(self, *, under_way: bool = False) -> None:
        """Raise PicoError (exit code INTERRUPTED) if the coordinator's lease is over."""
        if self._lock.granting is not None:
            self._lock.granting.require(under_way=under_way)

    def stops(self) -> Stopping:
        """Return whether a stepwise operation is to stop, and how: on request, or because the lease is over."""
        if not self._stopping:
            try:
                self._require(under_way=True)
            except PicoError:
                return "safely"
        return self._stopping

    async def halt(self) -> None:
        """Start nothing more, and wait until what is under way has reached a safe end."""
        self._name_who_stops()
        await self.halt_for_client()

    async def halt_for_client(self) -> None:
        """Halt, on behalf of the client of the run in progress."""
        self.interrupt()
        await self._apparatus.device.halt()

    async def stop(self) -> None:
        """Stop everything where it is; grippers hold what they hold. Nothing starts until the bench is taken anew."""
        self._name_who_stops()
        self.interrupt()
        self._stopping = "now"
        await self._apparatus.device.stop()

    async def drain(self) -> None:
        """Bring what is under way to its safe end, and take the bench back from whoever has it."""
        if (lease := self.lease) is not None:
            self._ended_for = self._ended_for or LEASE_OVER
            await self.halt_for_client()
            await self.tenant.ended()
            await self.release(lease)

    async def end_of(self, holder: str) -> None:
        """Bring what a holder has under way to its safe end, and take the bench back from it."""
        if self.lease is not None and self.lease.holder == holder:
            await self.drain()

    def interrupt(self) -> None:
        """Start nothing more until the bench is taken anew."""
        self.halted, self._stopping = True, self._stopping or "safely"
        self.tenant.interrupt()

    def why_ended(self) -> str:
        """Return why what was under way was ended by somebody else than its client; empty if it was not."""
        if not self._ended_for and self._lock.granting is not None:
            try:
                self._lock.granting.require()
            except PicoError:  # a step asked that before anybody drained the bench
                return LEASE_OVER
        return self._ended_for

    def _name_who_stops(self) -> None:
        if who := from_afar():
            self._ended_for = self._ended_for or f"{who} stopped it"
