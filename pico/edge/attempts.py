"""The order of records and motion that all rests on: intent before anything, `started` before motion, the end before
anyone hears of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from pico.backends.device import Began
from pico.diagnostics import PicoError
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

    def __init__(
        self, journal: Journal, device: Executing, token: int, require: Callable[[], None] = lambda: None
    ) -> None:
        """`require` raises PicoError (exit code INTERRUPTED) where nothing may begin to move any more. Raises PicoError
        (exit code LOCKED) where somebody took the bench since this token was given."""
        self._journal, self._device, self._token, self._require = journal, device, token, require
        journal.fence(token)

    def known(self, operation: Operation, key: str) -> OperationResult | None:
        """Record the intent and return None, or return what became of this key before; then nothing must move."""
        return self._journal.intend(key, operation, self._token)

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        """Have an operation done whose intent is recorded, and return its result, which then is in the journal. Raises
        PicoError (exit code INTERRUPTED) where it may not begin any more, which is looked at once that is written, and
        right before it moves."""

        def began(before: ObservedComponent | None) -> None:
            self._require()
            self._journal.started(key, before, self._token)
            try:
                self._require()
            except PicoError as exc:
                kept = OperationResult(key=key, outcome="failed", error=exc.diagnostics[0], before=before)
                self._journal.ended(kept, self._token)
                raise

        result = await self._device.execute(operation, key, began)
        self._journal.ended(result, self._token)
        return result
