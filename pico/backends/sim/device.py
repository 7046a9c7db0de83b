"""The simulated bench as a device: the world that persists beside the lab."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.device import Began, Capabilities
from pico.backends.sim.plugins import plugged_in
from pico.backends.sim.readings import simulated
from pico.backends.sim.steering.pace import Pace
from pico.backends.sim.store import load_world, world_path
from pico.backends.sim.world import observe
from pico.diagnostics import Diagnostic, PicoError
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.record import remembered
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.motion.deferred import DeferredMotion
from pico.motion.types import Motion
from pico.places.bench import BenchPlace
from pico.planning.routines import plugged_in as routines
from pico.teleop.frames import STEPS

if TYPE_CHECKING:
    from pico.backends.last_seen import LastSeen
    from pico.backends.measured import Reading
    from pico.backends.sight import Look
    from pico.backends.sim.session import WorldSession
    from pico.backends.sim.table import SimulatedTable
    from pico.backends.sim.world import World
    from pico.backends.world import Held
    from pico.twin.moment import Moment
    from pico.twin.snapshot import Snapshot

PRIMITIVES = frozenset({"move", "stow", "set", "home", "park", "measure", "auto_range", "operator"})


@remembered
def _capabilities(setup: Setup, fidelity: str) -> Capabilities:
    return Capabilities(
        name="sim", fidelity=fidelity, evidence=fidelity, lab_digest=setup.digest(),
        primitives=PRIMITIVES | STEPS | plugged_in().keys() | routines().keys(), robots=tuple(sorted(setup.lab.robots)),
        measurables=frozenset(simulated(setup)), simulated=True,
    )  # fmt: skip


class SimDevice:
    """The simulated table of the bench at `place`.

    `motion` finds the paths (that of the lab's arms where None); `clock` gives the wall time as ISO 8601, UTC. It reads
    the table as it is stored until it is taken, and then is the only one that changes it.
    """

    def __init__(
        self,
        setup: Setup,
        place: BenchPlace,
        fidelity: str = "kinematic",
        *,
        clock: Callable[[], str],
        motion: Motion | None = None,
    ) -> None:
        self.setup, self.place, self.fidelity = setup, place, fidelity
        self.diagnostics: tuple[Diagnostic, ...] = ()
        self._clock, self._motion = clock, motion or DeferredMotion(setup)
        self.pace = Pace()
        """With which time passes in this world while a person steers."""
        self._session: WorldSession | None = None
        self._look: Callable[[Snapshot], None] | None = None
        self._looked: tuple[tuple[World, str | None], Look] | None = None
        self._placed: dict[str, LastSeen] = {}
        self._stored: tuple[tuple[int, ...], World] | None = None

    # looking

    def watch(self, look: Callable[[Snapshot], None] | None) -> None:
        """Let `look` see what moves from the next `take` on: often enough for a film. None: no more."""
        self._look = look

    async def describe(self) -> Capabilities:
        """Return what the simulator can do."""
        return _capabilities(self.setup, self.fidelity)

    async def observe(self) -> Observation:
        """Return the table as the lab says that it is looked at, exactly or by sight.

        Raises PicoError where its file can't be read, and by sight where cameras are dark or have moved.
        """
        if self.setup.lab.sim.observe == "sight":
            from pico.backends.sight import require_trusted

            return require_trusted(self._by_sight().observation)
        return self._felt(observe(self._world(), "sim", self._clock()))

    def _felt(self, seen: Observation) -> Observation:
        """Return what was seen, with what hands hold as a run by sight feels it: one that was killed while the fingers
        closed has hold of a part that still stands."""
        if not self.setup.lab.sim.runs_by_sight(self.fidelity):
            return seen
        from pico.backends.last_seen import recall_hands
        from pico.backends.sim.senses import sensed

        felt = sensed(self.setup, self._world(), recall_hands(self.place), seen.backend, seen.observed_at)
        full = {name for name, robot in felt.robots.items() if robot.holding and not seen.robots[name].holding}
        held = {n: felt.components[n] for n in (felt.robots[name].holding for name in full) if n}
        robots = {name: felt.robots[name] if name in full else robot for name, robot in seen.robots.items()}
        return replace(seen, robots=robots, components={**seen.components, **held})

    async def look(self) -> Look:
        """Return what the cameras see of the table, whatever the lab says; raises PicoError where there are none."""
        return self._by_sight()

    async def moment(self) -> Moment:
        """Return where everything is now; raises PicoError where the table's file can't be read."""
        from pico.backends.sim.bodies import body_placement
        from pico.twin.moment import Moment

        world = self._session.world() if self._session is not None else self._as_stored()
        placed = {name: body_placement(self.setup, world, name) for name in world.components}
        places = {name: place for name, place in placed.items() if place is not None}
        return Moment(observe(world, "sim", ""), places, world.openings)

    def _as_stored(self) -> World:
        """Return the table as it is stored, read again only once its file is another one."""
        now: tuple[int, ...] = ()
        with suppress(OSError):
            found = world_path(self.place).stat()
            now = (found.st_ino, found.st_mtime_ns, found.st_size)
        if self._stored is None or self._stored[0] != now:
            self._stored = now, load_world(self.setup, self.place)[0]
        return self._stored[1]

    def _world(self) -> World:
        if self._session is not None:
            return self._session.world()
        world, self.diagnostics = load_world(self.setup, self.place)
        return world

    def _by_sight(self) -> Look:
        """Look through the cameras; the same table looks the same again, so that it is not looked at twice."""
        from pico.backends.last_seen import noted, recall, remember
        from pico.backends.sight import BLIND
        from pico.backends.sim.sight import see
        from pico.vision.calibration_files import calibration_digest

        world, calibration = self._world(), calibration_digest(self.place.root, self.place.name)
        if self._looked is None or self._looked[0] != (world, calibration):
            last = {**recall(self.place), **self._placed}
            found = see(self.setup, self.place, world, "sim", self._clock(), last)
            if not any(problem.code in BLIND for problem in found.observation.problems):
                remember(self.place, noted(last, found.observation))
                self._placed.clear()
            self._looked = (world, calibration), found
        return self._looked[1]

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Return what a measurement would give now, of which nothing is assured, and nothing is opened for it; raises
        PicoError."""
        from pico.backends.attempt import Failed
        from pico.backends.sim.measuring import measured

        world, now = self._world(), self._clock()
        try:  # in a thread of its own: who steers is heard meanwhile
            return await asyncio.to_thread(measured, self.setup, self.place, world, component, measurable, None, now)
        except Failed as exc:
            raise PicoError(exc.diagnostic) from exc

    async def snap(self, component: str, measurable: str) -> Reading:
        """Return what is read now of a measurable, and keep nothing; raises PicoError."""
        from pico.backends.attempt import Failed
        from pico.backends.sim.measuring import require_simulated
        from pico.backends.sim.readings import Table

        try:
            measurer = require_simulated(self.setup, component, measurable)[1]
            table = Table(self.setup, self.place, self._world())
            return await asyncio.to_thread(measurer.read, table, component, measurable)
        except Failed as exc:
            raise PicoError(exc.diagnostic) from exc

    # moving

    async def take(self, token: int, tell: Callable[[Event], None], require: Callable[[], None] = lambda: None) -> None:
        """Read the table, which stands still while its process is frozen; raises PicoError where its files are
        broken."""
        from pico.backends.sim.faults import faults_of
        from pico.backends.sim.session import WorldSession

        world, self.diagnostics = load_world(self.setup, self.place)
        self._session = WorldSession(
            self.setup, self.place, world, fidelity=self.fidelity, token=token, motion=self._motion, tell=tell,
            clock=self._clock, faults=faults_of(self.setup, self.place),
            look=self._by_sight if self.setup.lab.sim.runs_by_sight(self.fidelity) else None, pace=self.pace,
        )  # fmt: skip
        if self._look is not None:
            self._session.watch(self._look)

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute one operation in simulated time and return when it has ended and is stored."""
        assert self._session is not None  # only who has taken the device executes
        result = await self._session.execute(operation, key, began)
        if result.outcome == "done" and (operation.kind.carries or operation.primitive == "let_go"):
            self._note_placed(operation, result)
        return result

    def _note_placed(self, operation: Operation, result: OperationResult) -> None:
        """Remember where an arm put a part down, for it may hide it from the cameras; also after a kill."""
        from pico.backends.last_seen import placed_at, recall, remember

        self._placed[operation.component] = placed_at(self.setup, operation, result)
        if self.setup.lab.sim.runs_by_sight(self.fidelity):
            remember(self.place, {**recall(self.place), **self._placed})

    async def halt(self) -> None:
        """Wait until what is under way has reached a safe end."""
        if self._session is not None:
            await self._session.halt()

    async def stop(self) -> None:
        """Stop everything where it is; grippers hold what they hold."""
        if self._session is not None:
            await self._session.stop()

    async def leave(self) -> None:
        """Let others change the table again, once everything under way has ended."""
        if self._session is not None:
            await self._session.idle()
            self._session = None

    async def close(self) -> None:
        """Nothing leads to a simulated bench."""

    def kept(self) -> bool:
        """Return whether the table is stored."""
        return world_path(self.place).exists()

    def world(self, held: Held, require_kept: Callable[[], None]) -> SimulatedTable:
        """Return the simulated table, to be changed as a hand would."""
        from pico.backends.sim.table import SimulatedTable

        return SimulatedTable(self.setup, self.place, held, require_kept)
