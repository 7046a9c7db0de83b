"""The simulated bench: the world that persists beside the lab, behind the protocol of every backend."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pico.attachment import bench_folder
from pico.backends.lease import BenchLock, utc_now
from pico.backends.protocol import Capabilities, Lease
from pico.backends.sim import checks
from pico.backends.sim.plugins import plugged_in
from pico.backends.sim.readings import simulated
from pico.backends.sim.store import load_world
from pico.backends.sim.world import observe
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.event import Event
from pico.model.lab import Setup
from pico.model.measurement import Measurement
from pico.model.observation import Observation, Uncertainty
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.motion.deferred import DeferredMotion
from pico.motion.types import Motion

if TYPE_CHECKING:
    from pico.backends.last_seen import LastSeen
    from pico.backends.recovery import SettledOperation
    from pico.backends.sight import Look
    from pico.backends.sim.session import WorldSession
    from pico.backends.sim.world import World
    from pico.runs.journal import Journal
    from pico.twin.snapshot import Snapshot

PRIMITIVES = frozenset({"move", "stow", "set", "home", "park", "measure"})

OBEYS = 0.02
"""Seconds of wall time between two looks at whether somebody asked to stop."""


class SimBackend:
    """Executes operations on the simulated table of the lab in folder `root`.

    `motion` finds the paths (that of the lab's arms where None); `clock` gives the wall time as ISO 8601, UTC. Without
    a lease it reads the table as it is stored; with one it is the only one that changes it. `settled`: what had begun
    and was found out about when the bench was taken. `lock_timeout`: so long it waits for who has the bench [s].
    """

    def __init__(
        self,
        setup: Setup,
        root: Path,
        fidelity: str = "kinematic",
        *,
        motion: Motion | None = None,
        clock: Callable[[], str] = utc_now,
    ) -> None:
        self.setup, self.root, self.fidelity = setup, root, fidelity
        self.diagnostics: tuple[Diagnostic, ...] = ()
        self.settled: tuple[SettledOperation, ...] = ()
        self._lock, self._clock = BenchLock(root, clock), clock
        self._motion = motion or DeferredMotion(setup)
        self._session: WorldSession | None = None
        self._halted = False
        self.lock_timeout = 0.0
        self._obeying: asyncio.Task[None] | None = None
        self._journal: Journal | None = None
        self._listeners: list[asyncio.Queue[Event | None]] = []
        self._look: Callable[[Snapshot], None] | None = None
        self._looked: tuple[tuple[World, str | None], Look] | None = None
        self._placed: dict[str, LastSeen] = {}

    # looking

    def watch(self, look: Callable[[Snapshot], None] | None) -> None:
        """Let `look` see what moves, whoever takes the bench from now on: often enough for a film. None: no more."""
        self._look = look

    @property
    def journal(self) -> Journal:
        """The journal of the bench, opened when it is first needed; raises PicoError."""
        if self._journal is None:
            from pico.runs.journal import Journal

            self._journal = Journal(bench_folder(self.root) / "journal.sqlite", self._clock)
        return self._journal

    async def describe(self) -> Capabilities:
        """Return what the simulator can do."""
        return Capabilities(
            name="sim",
            fidelity=self.fidelity,
            evidence=self.fidelity,
            lab_digest=self.setup.digest(),
            primitives=PRIMITIVES | plugged_in().keys(),
            robots=tuple(sorted(self.setup.lab.robots)),
            measurables=frozenset(simulated(self.setup)),
        )

    async def observe(self) -> Observation:
        """Return the table as the lab says that it is looked at, exactly or by sight.

        Raises PicoError where its file can't be read, and by sight where cameras are dark or have moved.
        """
        if self.setup.lab.sim.observe == "sight":
            from pico.backends.sight import require_trusted

            return require_trusted(self._by_sight().observation)
        return self._with_hands(observe(self._world(), "sim", self._clock()))

    async def scan(self) -> Look:
        """Return what the cameras see of the table, whatever the lab says, also what is wrong with them.

        Raises PicoError where there are none.
        """
        return self._by_sight()

    def _world(self) -> World:
        if self._session is not None:
            return self._session.world()
        world, self.diagnostics = load_world(self.setup, self.root)
        return world

    def _by_sight(self) -> Look:
        """Look through the cameras; the same table looks the same again, so that it is not looked at twice."""
        from pico.backends.last_seen import noted, recall, remember
        from pico.backends.sight import BLIND
        from pico.backends.sim.sight import see
        from pico.vision.calibration import calibration_digest

        world, calibration = self._world(), calibration_digest(self.root)
        if self._looked is None or self._looked[0] != (world, calibration):
            last = {**recall(self.root), **self._placed}
            found = see(self.setup, self.root, world, "sim", self._clock(), last)
            found = replace(found, observation=self._with_hands(found.observation))
            if not any(problem.code in BLIND for problem in found.observation.problems):
                remember(self.root, noted(last, found.observation))
                self._placed.clear()
            self._looked = (world, calibration), found
        return self._looked[1]

    def _with_hands(self, seen: Observation) -> Observation:
        """Return the observation with what the journal knows of the parts in the hands: where they were picked."""
        if not any(robot.holding for robot in seen.robots.values()):
            return seen
        from pico.backends.grip import with_picks

        try:
            return with_picks(self.setup, self.journal, seen)
        except PicoError as exc:  # looking must not fail because of the journal
            self.diagnostics = (*self.diagnostics, *exc.diagnostics)
            return seen

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Return what a measurement would give now, of which nothing is assured; raises PicoError, for light above all:
        that is not simulated yet."""
        from pico.backends.attempt import Failed
        from pico.backends.sim.measuring import measured

        try:
            return measured(self.setup, self.root, self._world(), component, measurable, None)
        except Failed as exc:
            raise PicoError(exc.diagnostic) from exc

    def events(self) -> AsyncGenerator[Event, None]:
        """Yield start and progress of the operations in execution, from now on until the backend is closed."""
        queue: asyncio.Queue[Event | None] = asyncio.Queue()
        self._listeners.append(queue)
        return self._listen(queue)

    async def _listen(self, queue: asyncio.Queue[Event | None]) -> AsyncGenerator[Event, None]:
        try:
            while (event := await queue.get()) is not None:
                yield event
        finally:
            self._listeners.remove(queue)

    # who may move it

    async def acquire(self, holder: str) -> Lease:
        """Take the bench; raises PicoError (exit code LOCKED) where somebody has it, and where its files are broken."""
        from pico.backends.recovery import open_questions, settle
        from pico.backends.sim.faults import faults_of
        from pico.backends.sim.session import WorldSession

        self._halted = False
        lease = await self._lock.acquire_within(holder, self.lock_timeout, lambda: self._halted)
        try:
            world, self.diagnostics = load_world(self.setup, self.root)
            self._session = WorldSession(
                self.setup, self.root, world, fidelity=self.fidelity, journal=self.journal, token=lease.token,
                motion=self._motion, tell=self._tell, faults=faults_of(self.setup, self.root),
            )  # fmt: skip
            self.settled = settle(self.setup, self.journal, await self.observe(), lease.token)
            asked = open_questions(self.journal.unsettled())
            if asked:
                raise PicoError(asked)
            if self._look is not None:
                self._session.watch(self._look)
        except BaseException:
            self._session = None
            self._lock.release()
            raise
        self._obeying = asyncio.create_task(self._obey(lease))
        return lease

    async def release(self, lease: Lease) -> None:
        """Give the bench back, once everything under way has ended."""
        if self._session is not None and lease.token == self._session.token:
            await self._leave(self._session)

    async def _obey(self, lease: Lease) -> None:
        """Look all the time whether somebody asks at another terminal to stop, and do so."""
        from pico.backends.stopping import Asking, asked_to_stop

        last: Asking | None = None
        while True:
            asked = asked_to_stop(self.root, lease.token)
            if asked is not None and asked != last:
                last = asked
                await (self.stop() if asked == "now" else self.halt())
            await asyncio.sleep(OBEYS)

    async def _leave(self, session: WorldSession) -> None:
        await session.idle()
        if self._obeying is not None:
            self._obeying.cancel()
        self._session = None
        self._lock.release()

    async def close(self) -> None:
        """Wait for what is under way, give the bench back, end the streams of events."""
        self._halted = True
        if self._session is not None:
            await self._leave(self._session)
        if self._journal is not None:
            self._journal.close()
            self._journal = None
        for queue in self._listeners:
            queue.put_nowait(None)

    # moving

    async def execute(self, operation: Operation, key: str, lease: Lease) -> OperationResult:
        """Execute one operation in simulated time and return when it has ended.

        Cancelling the wait does not cancel the motion. Raises PicoError: exit code LOCKED without the current lease,
        INTERRUPTED on a halted bench, ERROR for a known key with other content or a journal that can't be written.
        """
        session = self._session
        if session is None or lease.token != session.token:
            text = f"the lease {lease.token} of {lease.holder} is not the current one"
            raise PicoError(error("lease", text), ExitCode.LOCKED)
        if self._halted:
            raise PicoError(checks.HALTED, ExitCode.INTERRUPTED)
        result = await session.execute(operation, key)
        if result.outcome == "done" and operation.kind.carries:
            self._note_placed(operation, result.ended)
        return result

    def _note_placed(self, operation: Operation, time: float) -> None:
        """Remember where an arm put a part down, for it may hide it from the cameras."""
        from pico.backends.last_seen import LastSeen

        repeatability = self.setup.type_of(operation.component).repeatability
        sigma = Uncertainty(position=repeatability.position, yaw=repeatability.yaw)
        pose = Pose(**operation.arguments["to"]["pose"])
        self._placed[operation.component] = LastSeen(pose=pose, uncertainty=sigma, time=time, placed=True)

    async def halt(self) -> None:
        """Start nothing more, and wait until what is under way has reached a safe end: an arm then stands above the
        place where it put its component down, or is parked."""
        self._halted = True
        if self._session is not None:
            await self._session.halt()

    async def stop(self) -> None:
        """Stop everything where it is; grippers hold what they hold. Nothing starts until the bench is taken anew."""
        self._halted = True
        if self._session is not None:
            await self._session.stop()

    def _tell(self, event: Event) -> None:
        for queue in self._listeners:
            queue.put_nowait(event)
