"""What moves and looks: the protocol that simulator, emulated and real hardware implement, and nothing else of PICO.

A device has no memory: who may move it, what is written down before and after an operation, and runs belong to the edge
that owns it (`pico.edge`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from pico.model.commissioning import Basis
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation, ObservedComponent
from pico.model.operation import Operation, OperationResult
from pico.model.record import record
from pico.model.trace.event import Event

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.hardware.guard.verdict import Trip
    from pico.backends.measured import Reading
    from pico.backends.sight import Look
    from pico.backends.world import Held, World
    from pico.twin.moment import Moment
    from pico.twin.snapshot import Snapshot

Began = Callable[[ObservedComponent | None], None]
"""Called with the component as it is, just before anything of an operation moves; what it raises keeps it from that."""


@record
class Capabilities:
    """What a device can do. `evidence` is what its runs count as: kinematic, physics, emulated or hardware.

    `measurables`: what it can measure, as addresses (`p2.pose`). `simulated`: it has a `World` of its own, and a clock
    that is none on the wall. `kept`: its table was there before; a simulated one that nobody used is made up.
    """

    name: str
    fidelity: str
    evidence: str
    lab_digest: str
    primitives: frozenset[str]
    robots: tuple[str, ...]
    measurables: frozenset[str] = frozenset()
    unmodelled: tuple[str, ...] = ()
    simulated: bool = False
    kept: bool = True


@runtime_checkable
class Commissioned(Protocol):
    """A device that a person must have commissioned before a laser above class 2 emits there."""

    async def basis(self) -> Basis:
        """Return what a report of it would be of now; raises PicoError for what does not answer."""
        ...


@runtime_checkable
class Clearable(Protocol):
    """A device whose instruments keep faults until a person clears them."""

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults of all instruments; moves nothing. Raises PicoError for links that are lost."""
        ...

    async def clear(self, name: str) -> None:
        """Clear the faults of an instrument for a person who was at the table; moves nothing. Raises PicoError naming
        what is still to be done."""
        ...


@runtime_checkable
class Shown(Protocol):
    """A device that knows where everything is while it moves, for who draws the bench."""

    async def moment(self) -> Moment:
        """Return the bench as it is now, as far as that is known without looking. Moves, lights and waits for
        nothing."""
        ...


@runtime_checkable
class LightGuarded(Protocol):
    """A device whose light is guarded whether or not anybody has taken it, and can be ended at any time."""

    def listen(
        self, heard: Callable[[Ended, Trip | None], None], disarm: Callable[[str], tuple[str, ...]] | None = None
    ) -> None:
        """Have `heard` called, in any thread, after light was ended, by the guard (with its trip) or by a stop.
        `disarm`: ends what arms lasers above class 2, on behalf of whom it is told, and returns of which; called
        after a stop and a trip by a door, an emergency stop, a key or an interlock."""
        ...

    async def guarded(self) -> None:
        """Connect to the devices, and guard their light from now on; raises PicoError for what does not answer."""
        ...

    def guards(self) -> bool:
        """Return whether the bench has a laser that a device could make dark; asks no device."""
        ...

    def may_emit(self) -> bool:
        """Return whether a laser may emit that this process guards: it is connected, and not all are proven dark."""
        ...

    def dark_by_itself(self) -> frozenset[str]:
        """Return the lasers whose light ends by itself once PICO is dead or frozen: they have a dead-man."""
        ...

    async def end_light(self, *, at_end: bool = False) -> Ended:
        """End all light now, for a person who asks for that, and return what became of each laser; needs no lease, and
        no device but those of lasers and shutters. `at_end`: because this process ends, and no armings with it. Raises
        PicoError if these can't be had at all."""
        ...


class Device(Protocol):
    """What executes operations, for the one edge that has it."""

    async def describe(self) -> Capabilities: ...

    async def observe(self) -> Observation:
        """Look, and return what was seen. Moves nothing; raises PicoError where nothing can be seen."""
        ...

    async def look(self) -> Look:
        """Look through the cameras, whatever the lab says, and return what they see, also what is wrong with them. What
        lights the room is on for it, and afterwards as it was.

        Raises PicoError where there are none.
        """
        ...

    async def take(self, token: int, tell: Callable[[Event], None], require: Callable[[], None]) -> None:
        """Get ready to move: until `leave`, nobody else does. `tell` hears of the start and progress of operations.

        `token` is that of the lease; `require` raises PicoError where that is over, and is asked in the middle of an
        operation, too, by what goes on while nobody sees that: where a process was frozen that leads a real bench.
        Raises PicoError where the bench is not fit to be moved.
        """
        ...

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute one operation and return when it has ended, and what it left is durable.

        `key` is `run id/operation id/attempt`. A failure is a result, not an exception; raises PicoError with exit code
        INTERRUPTED where it was stopped before it began. Cancelling the wait does not cancel the motion.
        """
        ...

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, opening nothing: nothing of it is assured. Raises PicoError where it
        can't be."""
        ...

    async def snap(self, component: str, measurable: str) -> Reading:
        """Read a measurable as `peek` does, and keep nothing of it. Raises PicoError where it can't be."""
        ...

    async def halt(self) -> None:
        """Bring everything under way to its safe end: an arm then stands above the place where it put its component
        down, or is parked."""
        ...

    async def stop(self) -> None:
        """Stop all motion now, decelerated; grippers hold what they hold."""
        ...

    async def leave(self) -> None:
        """Let go of what `take` took, once everything under way has ended."""
        ...

    async def close(self) -> None:
        """Let go of what leads to the bench; it opens again when it is needed."""
        ...

    def watch(self, look: Callable[[Snapshot], None] | None) -> None:
        """Let `look` see what moves from the next `take` on, often enough for a film; None: no more.

        Raises PicoError where nothing is simulated.
        """
        ...

    def kept(self) -> bool:
        """Return whether what the device itself keeps of its table is there; that of a real one always is."""
        ...

    def world(self, held: Held, require_kept: Callable[[], None]) -> World:
        """Return the simulated world, to be changed as a hand would; raises PicoError where nothing is simulated.

        `held` locks the bench for a change; `require_kept` raises PicoError where the world's own file was lost.
        """
        ...
