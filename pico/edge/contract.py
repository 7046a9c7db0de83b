"""What a client knows of a bench and does to it: a device with a memory. In one process, or at the far end of a link.

Four parts, so that who needs one of them asks for that alone: `EdgeSight`, `EdgeLicensing`, `EdgeCustody` and
`EdgeRuns`; `Edge` is all four, with the Lab, the memory and the world of the bench. Arguments and results are model
types, serializable. One contract suite runs on every edge (`tests/edge`).
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import TYPE_CHECKING, Protocol

from pico.backends.device import Capabilities
from pico.backends.world import World
from pico.edge.protocol import Holder, Job, Lease, OwnLab
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome
from pico.model.trace.event import Event
from pico.teleop.frames import Answer, Frame

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.sight import Look
    from pico.edge.armings import Kept
    from pico.model.arming import Arming
    from pico.model.trace.dose import Dose
    from pico.model.trace.report import RunReport
    from pico.model.trace.run import RunOutcome
    from pico.model.trace.unattended import Left, Terms
    from pico.runs.memory import Memory
    from pico.twin.snapshot import Snapshot


class EdgeSight(Protocol):
    """What one sees of a bench. Moves nothing, and needs no lease."""

    async def describe(self) -> Capabilities: ...

    async def observe(self) -> Observation:
        """Look, and return what was seen, with what is known of the parts in the hands and what may emit. Moves
        nothing."""
        ...

    async def look(self) -> Look:
        """Look through the cameras and return what they see; raises PicoError where there are none."""
        ...

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, without lease, opening nothing: nothing of it is assured, and it enters
        no trace, expectation or goal. Raises PicoError where it can't be.
        """
        ...

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults that devices of the bench keep until they are cleared; empty for a simulated one. Raises
        PicoError for links that are lost."""
        ...


class EdgeLicensing(Protocol):
    """What a bench lets emit, how much light its samples had, and runs that run unattended."""

    async def armings(self) -> tuple[Kept, ...]:
        """Return what the bench keeps of armings, also those that are over, or broken."""
        ...

    async def arm(self, arming: Arming) -> Arming:
        """Keep an arming: what then lets its laser emit is an operation like any other, which it allows. Return it as
        it is kept. Raises PicoError (exit code DENIED) for a person, a class or a time that the lab's policy does not
        allow. Needs no lease.
        """
        ...

    async def disarm(self, laser: str, by: str) -> bool:
        """End what arms a laser, at once and whoever has the bench, who shuts it. Return whether it is shut; else it
        will be, by who has the bench next. Needs no lease."""
        ...

    async def doses(self) -> tuple[Dose, ...]:
        """Return how much light each sample of the bench has had until now, and may have. A plan, or an operation, that
        would give one more is refused (exit code DENIED)."""
        ...

    async def hold(self, terms: Terms) -> Left | None:
        """Hold an unattended run to its terms until it is left: no laser emits as of a higher class, and at its latest
        end, or where its client is gone or says nothing for long, it is ended, and the bench brought to its end state.
        Return how the edge left the bench if it ended that run before. Raises PicoError (exit code LOCKED) where one is
        held."""
        ...

    async def goes_on(self, recipe: str) -> None:
        """Report that the client of a run under its lease is still there. Raises PicoError (exit code INTERRUPTED)
        where the edge ended it; nothing is started for it then, either."""
        ...

    async def leave(self, recipe: str, moves: bool) -> Left:
        """Bring about the end state of a run that is held, unless the edge did so; return how the bench is left. Where
        nothing `moves` any more, for somebody interrupted it, arms stay where they are, and the run may be taken up."""
        ...

    async def unattended(self) -> Terms | None:
        """Return the terms of the unattended run in progress, or of the last that was not ended by its client as it
        states; None for none."""
        ...


class EdgeCustody(Protocol):
    """Who has a bench, the operations that they have it execute, and what stops these. What moves it without the
    current lease raises PicoError with exit code LOCKED."""

    async def holder(self) -> Holder | None:
        """Return who moves the bench, None if it is free."""
        ...

    async def acquire(self, holder: str, wait: float = 0.0) -> Lease:
        """Take the bench, within `wait` seconds; raises PicoError (exit code LOCKED) naming who has it.

        What had begun and has no end is settled by looking; raises PicoError where only a person can tell.
        """
        ...

    async def release(self, lease: Lease) -> None:
        """Give the bench back, once everything under way has ended."""
        ...

    async def execute(self, operation: Operation, key: str, lease: Lease) -> OperationResult:
        """Execute one operation and return when it has ended; it is journalled before it moves and before this returns.

        `key` is `run id/operation id/attempt`. A known key returns its recorded result and moves nothing; the same
        key with other content raises PicoError. A failure is a result, not an exception.
        """
        ...

    async def clear_fault(self, device: str, by: str) -> None:
        """Clear the faults of a device, for `by`, who was at the table and confirmed it at a terminal of the bench's
        own computer; moves nothing. No coordinator relays this. Raises PicoError if the bench is in use (exit code
        LOCKED), and naming what is still to be done."""
        ...

    async def halt(self) -> None:
        """Dispatch nothing more and bring every robot to a safe waypoint. Needs no lease."""
        ...

    async def stop(self) -> None:
        """Stop all motion now, decelerated; grippers hold what they hold, and light ends. Needs no lease."""
        ...

    async def end_light(self) -> Ended | None:
        """End all light now and return what became of each laser, None for a bench that emits nothing. Needs no lease;
        raises PicoError if no device can be had at all."""
        ...


class EdgeRuns(Protocol):
    """Runs on a bench: begun, followed and ended."""

    async def unended(self) -> str | None:
        """Return the run that has begun and not ended: the one in progress, else one that was killed; None for none."""
        ...

    async def start(self, job: Job, run: str) -> str:
        """Check a plan again, start a run of it under the id `run`, and return that; it ends whoever listens.

        A run that was started already is not started again. Raises PicoError before anything moves: exit code
        IMPOSSIBLE for a plan with errors, STALE where the bench or the lab changed since it was made, DENIED by the
        lab's policy, LOCKED where somebody else has the bench, ERROR where the device can't do what the plan asks.
        """
        ...

    async def open(self, job: Job, run: str) -> Lease:
        """Take the bench and begin a run under the id `run` that stays open: its plan has no operations, and says what
        it is for. What is then started `within` it is journalled under its id, checked as any plan is, one after the
        other. Giving the lease back ends it as `interrupted`; killed, it has no end. Raises PicoError as `start` does.
        """
        ...

    async def finish(self, run: str, outcome: RunOutcome) -> RunReport:
        """End an open run, give the bench back, and return what became of it; raises PicoError where it is not open."""
        ...

    def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        """Yield what happened in a run after its event `since`, and what happens, up to `run_finished`.

        Raises PicoError for a run that was not started here.
        """
        ...

    async def report(self, run: str) -> RunReport:
        """Wait for the end of a run, and return what became of it; raises PicoError for what cut it short."""
        ...

    async def film(self, run: str) -> list[Snapshot]:
        """Return what a film of a run shows that was `filmed`."""
        ...

    async def jog(self, run: str, frame: Frame) -> Answer:
        """Say what a hand on a key says to the teleoperation in a run: a frame authorizes one step at most, and silence
        ends all motion within `pico.teleop.frames.SILENCE`. An answer whose phase is `over` says that nothing is
        steered there, yet or any more. Raises PicoError for a run that was not started here."""
        ...

    async def cancel(self, run: str) -> None:
        """Start nothing more of a run, and bring everything to a safe end."""
        ...


class Edge(EdgeSight, EdgeLicensing, EdgeCustody, EdgeRuns, Protocol):
    """One bench."""

    async def lab(self) -> OwnLab | None:
        """Return the Lab of the bench, which the edge owns; None on trial, where nothing is kept."""
        ...

    async def adopt(self, lab: OwnLab, holder: str) -> None:
        """Take another Lab as the bench's own, for `holder`, while the bench is free.

        Raises PicoError: exit code LOCKED, STALE where it was changed meanwhile, and for what is wrong with `lab`.
        """
        ...

    @property
    def memory(self) -> Memory | None:
        """What the bench remembers of its runs; None where there was none yet."""
        ...

    async def resolve(self, key: str, outcome: Outcome, by: str) -> None:
        """Record what a person says of an operation that only a person can tell the end of.

        Raises PicoError if no question is open under `key`, or if the bench is in use (exit code LOCKED).
        """
        ...

    @property
    def world(self) -> World:
        """The simulated world; raises PicoError if this bench is not simulated."""
        ...

    async def close(self) -> None:
        """Let go of everything; what is under way in this process comes to its safe end before."""
        ...
