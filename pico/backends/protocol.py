"""The one protocol that simulator, emulated and real hardware speak, and later a bench at the end of a network.

Arguments and results are model types, serializable. Capabilities are checked before anything starts.
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Protocol

from pico.model.event import Event
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.record import record


@record
class Capabilities:
    """What a backend can do. `evidence` is what its runs count as: kinematic, physics, emulated or hardware.
    `measurables`: what it can measure, as addresses (`p2.pose`)."""

    name: str
    fidelity: str
    evidence: str
    lab_digest: str
    primitives: frozenset[str]
    robots: tuple[str, ...]
    measurables: frozenset[str] = frozenset()
    unmodelled: tuple[str, ...] = ()


@record
class Lease:
    """The right to move a bench. Every mutating call carries its token; tokens of a bench strictly increase."""

    token: int
    holder: str
    since: str


class Backend(Protocol):
    """What executes operations. A mutating call without the current lease raises PicoError with exit code 5."""

    async def describe(self) -> Capabilities: ...

    async def observe(self) -> Observation:
        """Look, and return what was seen. Moves nothing."""
        ...

    async def acquire(self, holder: str) -> Lease:
        """Take the bench; raises PicoError (exit code 5) naming the holder where somebody else has it."""
        ...

    async def release(self, lease: Lease) -> None: ...

    async def execute(self, operation: Operation, key: str, lease: Lease) -> OperationResult:
        """Execute one operation and return when it has ended; the backend journals before it moves.

        `key` is `run id/operation id/attempt`. A known key returns its recorded result and moves nothing; the same
        key with other content raises PicoError. A failure is a result, not an exception.
        """
        ...

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, without lease, opening nothing: nothing of it is assured, and it enters
        no trace, expectation or goal. Raises PicoError where the backend can't.
        """
        ...

    def events(self) -> AsyncIterator[Event]:
        """Yield progress of the operations in execution, until the backend is closed."""
        ...

    async def halt(self) -> None:
        """Dispatch nothing more and bring every robot to a safe waypoint."""
        ...

    async def stop(self) -> None:
        """Stop all motion now, decelerated; grippers hold what they hold."""
        ...

    async def close(self) -> None:
        """Store what must persist and let go of everything."""
        ...
