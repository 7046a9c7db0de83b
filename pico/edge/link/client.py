"""An edge at the far end of a line: a Unix socket of this machine, or a coordinator on the network."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.backends.device import Capabilities
from pico.edge.armings import Kept
from pico.edge.link import wire
from pico.edge.link.line import Line
from pico.edge.protocol import Holder, Job, Lease, OwnLab
from pico.model.arming import Arming
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome
from pico.model.pose import Pose
from pico.model.trace.dose import Dose
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.model.trace.run import RunOutcome
from pico.model.trace.unattended import Left, Terms
from pico.runs.journal import JournalRecord, RunRecord, Success, Unsettled
from pico.teleop.frames import Answer, Frame
from pico.vision.calibration import calibration_from_json

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.sight import Look
    from pico.twin.placement import Placement
    from pico.twin.snapshot import Snapshot
    from pico.vision.arm import ArmOffsets
    from pico.vision.camera import CameraModel


class RemoteMemory:
    """What the bench remembers; see `pico.runs.memory.Memory`. What it said of runs that are done stays as it is, and
    is asked for once."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self._done: dict[str, tuple[JournalRecord, ...] | None] = {}

    def runs(self) -> tuple[RunRecord, ...]:
        """Return the runs in the order in which they began."""
        found: tuple[RunRecord, ...] = self._line.call("memory.runs")
        for run in found:
            if run.outcome == "done":
                self._done.setdefault(run.run)
        return found

    def last(self) -> RunRecord | None:
        """Return the run that began last, None where none did."""
        found: RunRecord | None = self._line.call("memory.last")
        return found

    def moving(self) -> frozenset[str]:
        """Return the runs that began at least one operation."""
        found: frozenset[str] = self._line.call("memory.moving")
        return found

    def document(self, run: str) -> str | None:
        """Return the plan that a run began with, as JSON."""
        found: str | None = self._line.call("memory.document", run)
        return found

    def about(self, run: str) -> tuple[tuple[Mapping[str, Any], ...], Mapping[str, Any] | None]:
        """Return what was recorded of a run each time that it was begun, and how the bench was observed afterwards."""
        found: wire.About = self._line.call("memory.about", run)
        return found

    def records(self, *, run: str | None = None, key: str | None = None) -> tuple[JournalRecord, ...]:
        """Return the records of a run, of a key, or all."""
        if run is not None and key is None and (known := self._done.get(run)) is not None:
            return known
        found: tuple[JournalRecord, ...] = self._line.call("memory.records", run, key)
        if run in self._done and key is None:
            self._done[run] = found
        return found

    def successes(self, components: Collection[str]) -> Iterator[Success]:
        """Yield the operations on some components that succeeded, the last one first."""
        found: tuple[Success, ...] = self._line.call("memory.successes", sorted(components))
        return iter(found)

    def unsettled(self) -> tuple[Unsettled, ...]:
        """Return the operations that began and of which nobody knows how they ended."""
        found: tuple[Unsettled, ...] = self._line.call("memory.unsettled")
        return found


class RemoteWorld:
    """The simulated world at the far end; see `pico.backends.world.World`."""

    def __init__(self, line: Line) -> None:
        self._line = line

    def placements(self) -> Mapping[str, Placement]:
        """Return where the components are in space."""
        found: dict[str, Placement] = self._line.call("world.placements")
        return found

    def reset(self, seed: int | None = None) -> None:
        """Put every part home, in a world of its own seed."""
        self._line.call("world.reset", seed)

    def put(self, seen: Observation) -> None:
        """Let every part stand and read as in `seen`, in a new world."""
        self._line.call("world.put", seen)

    def nudge(self, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> Pose:
        """Push a component by (dx, dy) [mm], turn it by dyaw [deg], and return where it then stands."""
        found: Pose = self._line.call("world.nudge", name, dx, dy, dyaw)
        return found

    def bump(
        self, camera: str | None = None, *, shift: tuple[float, float, float], turn: tuple[float, float, float]
    ) -> None:
        """Bump a camera, all at the table where none is named, by `shift` [mm] and the rotation vector `turn` [deg]."""
        self._line.call("world.bump", camera, shift, turn)

    def true_cameras(self) -> Mapping[str, CameraModel]:
        """Return the cameras as they really are."""
        return calibration_from_json(self._line.call("world.true_cameras")).cameras

    def true_arms(self) -> Mapping[str, ArmOffsets]:
        """Return how the arms are really built."""
        found: Mapping[str, ArmOffsets] = self._line.call("world.true_arms")
        return found

    def remove(self, name: str) -> None:
        """Take a component off the table."""
        self._line.call("world.remove", name)

    def slip(self, name: str, tunable: str, by: float) -> None:
        """Let the true value of a tunable be `by` more, in its unit, than its axis reads."""
        self._line.call("world.slip", name, tunable, by)

    def upset(self, name: str, **by: float | str) -> None:
        """Let something befall a part that only light finds."""
        self._line.call("world.upset", name, by)

    def clear(self, name: str | None = None) -> tuple[str, ...]:
        """Take back what is hidden of a part, of every part if none is named; return the parts that had something."""
        return tuple(self._line.call("world.clear", name))

    def hidden(self) -> Mapping[str, Mapping[str, float | str]]:
        """Return what is hidden of each part of which something is."""
        found: Mapping[str, Mapping[str, float | str]] = self._line.call("world.hidden")
        return found

    def wait(self, seconds: float) -> None:
        """Let time pass on the bench's clock [s]."""
        self._line.call("world.wait", seconds)

    def power_cycle(self) -> None:
        """Switch the bench off and on."""
        self._line.call("world.power_cycle")

    def person(self, present: bool) -> None:
        """Let somebody step up to the table, or go away."""
        self._line.call("world.person", present)

    def faults(self, words: Sequence[str] = ()) -> Mapping[str, Any]:
        """Let faults happen from now on, none for `off`; return `rates` and `seed` in force."""
        found: dict[str, Any] = self._line.call("world.faults", list(words))
        return found


class RemoteEdge:
    """The edge at the far end of a line; see `pico.edge.contract.Edge`. Its runs go on without this process."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self._memory: RemoteMemory | None = None
        self._held: dict[int, Callable[[], None]] = {}
        self._kept: dict[str, Callable[[], None]] = {}

    async def _call(self, name: str, *arguments: Any) -> Any:
        return await self._line.answer(name, *arguments)

    async def describe(self) -> Capabilities:
        """Return what the device can do."""
        found: Capabilities = await self._call("describe")
        return found

    async def holder(self) -> Holder | None:
        """Return who moves the bench, None where nobody does."""
        found: Holder | None = await self._call("holder")
        return found

    async def unended(self) -> str | None:
        """Return the run that has begun and not ended, None for none."""
        found: str | None = await self._call("unended")
        return found

    async def lab(self) -> OwnLab | None:
        """Return the Lab of the bench."""
        found: OwnLab | None = await self._call("lab")
        return found

    async def adopt(self, lab: OwnLab, holder: str) -> None:
        """Take another Lab as the bench's own."""
        await self._call("adopt", lab, holder)

    async def armings(self) -> tuple[Kept, ...]:
        """Return what the bench keeps of armings."""
        found: tuple[Kept, ...] = await self._call("armings")
        return found

    async def arm(self, arming: Arming) -> Arming:
        """Keep an arming, and return it as it is kept."""
        found: Arming = await self._call("arm", arming)
        return found

    async def disarm(self, laser: str, by: str) -> bool:
        """End what arms a laser; return whether it is shut."""
        found: bool = await self._call("disarm", laser, by)
        return found

    async def hold(self, terms: Terms) -> Left | None:
        """Hold an unattended run to its terms; it is ended there where this process dies."""
        left, self._kept[terms.recipe] = await self._line.kept("hold", terms)
        found: Left | None = left
        return found

    async def goes_on(self, recipe: str) -> None:
        """Say that the client of an unattended run goes on."""
        await self._call("goes_on", recipe)

    async def leave(self, recipe: str, moves: bool) -> Left:
        """Bring about the end state of an unattended run."""
        found: Left = await self._call("leave", recipe, moves)
        if (let_go := self._kept.pop(recipe, None)) is not None:
            let_go()
        return found

    async def unattended(self) -> Terms | None:
        """Return the terms of an unattended run."""
        found: Terms | None = await self._call("unattended")
        return found

    async def doses(self) -> tuple[Dose, ...]:
        """Return how much light each sample has had."""
        found: tuple[Dose, ...] = await self._call("doses")
        return found

    async def observe(self) -> Observation:
        """Look, and return what was seen."""
        found: Observation = await self._call("observe")
        return found

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults that devices of the bench keep."""
        found: tuple[DeviceFault, ...] = await self._call("faults")
        return found

    async def clear_fault(self, device: str, by: str) -> None:
        """Clear the faults of a device, for a person who was at the table."""
        await self._call("clear_fault", device, by)

    async def look(self) -> Look:
        """Look through the cameras and return what they see."""
        from pico.edge.link.pictures import look_from_json

        document = await self._call("look")
        return await asyncio.to_thread(look_from_json, document, lambda name: self._line.call("array", name))

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, without lease; nothing of it is assured."""
        found: Measurement = await self._call("peek", component, measurable)
        return found

    async def acquire(self, holder: str, wait: float = 0.0) -> Lease:
        """Take the bench; it is given back where this process dies."""
        return await self._lease("acquire", holder, wait)

    async def _lease(self, name: str, *arguments: Any) -> Lease:
        lease, let_go = await self._line.kept(name, *arguments)
        self._held[lease.token] = let_go
        found: Lease = lease
        return found

    async def release(self, lease: Lease) -> None:
        """Give the bench back, once everything under way has ended."""
        let_go = self._held.pop(lease.token, None)
        if let_go is not None:
            let_go()
            while (who := await self.holder()) is not None and who.token == lease.token:
                await asyncio.sleep(0.005)

    async def execute(self, operation: Operation, key: str, lease: Lease) -> OperationResult:
        """Execute one operation and return when it has ended."""
        found: OperationResult = await self._call("execute", operation, key, lease)
        return found

    async def start(self, job: Job, run: str) -> str:
        """Check a plan again, start a run of it under the id `run`, and return that."""
        found: str = await self._call("start", job, run)
        return found

    async def open(self, job: Job, run: str) -> Lease:
        """Take the bench and begin a run that stays open, until this process dies."""
        return await self._lease("open", job, run)

    async def finish(self, run: str, outcome: RunOutcome) -> RunReport:
        """End an open run, give the bench back, and return what became of it."""
        found: RunReport = await self._call("finish", run, outcome)
        return found

    async def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        """Yield what happened in a run after its event `since`, and what happens."""
        async for event in self._line.answers("events", run, since):
            yield event

    async def report(self, run: str) -> RunReport:
        """Wait for the end of a run, and return what became of it."""
        found: RunReport = await self._call("report", run)
        return found

    async def film(self, run: str) -> list[Snapshot]:
        """Return what a film of a run shows that was `filmed`."""
        found: list[Snapshot] = await self._call("film", run)
        return found

    async def jog(self, run: str, frame: Frame) -> Answer:
        """Say what a hand on a key says to the teleoperation in a run."""
        found: Answer = await self._call("jog", run, frame)
        return found

    async def cancel(self, run: str) -> None:
        """Start nothing more of a run, and bring everything to a safe end."""
        await self._call("cancel", run)

    async def halt(self) -> None:
        """Dispatch nothing more and bring every robot to a safe waypoint."""
        await self._call("halt")

    async def stop(self) -> None:
        """Stop all motion now; grippers hold what they hold, and light ends."""
        await self._call("stop")

    async def end_light(self) -> Ended | None:
        """End all light now, and return what became of each laser."""
        found: Ended | None = await self._call("end_light")
        return found

    @property
    def memory(self) -> RemoteMemory | None:
        """What the bench remembers of its runs; None where there was none yet."""
        if self._memory is None and self._line.call("memory"):
            self._memory = RemoteMemory(self._line)
        return self._memory

    async def resolve(self, key: str, outcome: Outcome, by: str) -> None:
        """Record what a person says of an operation that only a person can tell the end of."""
        await self._call("resolve", key, outcome, by)

    @property
    def world(self) -> RemoteWorld:
        """The simulated world; raises PicoError where nothing is simulated."""
        self._line.call("world")
        return RemoteWorld(self._line)

    async def close(self) -> None:
        """Give back what was taken; the edge itself goes on."""
        for let_go in (*self._held.values(), *self._kept.values()):
            let_go()
        self._held.clear()
        self._kept.clear()
        self._line.close()
