"""The order of records and motion that all rests on: intent before anything, `started` before motion, the end before
anyone hears of it."""

from __future__ import annotations

from typing import Protocol

from pico.backends.device import Began
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult
from pico.runs.journal import Journal


class Executing(Protocol):
    """What an attempt needs of a device."""

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """See `pico.backends.device.Device`."""
        ...


class Attempts:
    """Has a device execute operations, each key once, and journals them. `token` is that of the lease."""

    def __init__(self, journal: Journal, device: Executing, token: int) -> None:
        """Raises PicoError (exit code LOCKED) where somebody took the bench since this token was given."""
        self._journal, self._device, self._token = journal, device, token
        journal.fence(token)

    def known(self, operation: Operation, key: str) -> OperationResult | None:
        """Record the intent and return None, or return what became of this key before; then nothing must move."""
        return self._journal.intend(key, operation, self._token)

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        """Have an operation done whose intent is recorded, and return its result, which then is in the journal."""

        def began(before: ObservedComponent | None) -> None:
            self._journal.started(key, before, self._token)

        result = await self._device.execute(operation, key, began)
        self._journal.ended(result, self._token)
        return result
