"""Operations whose primitive states what must hold: asked on the bench itself just before, and again afterwards."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Protocol

from pico.backends.device import Began
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.setup import Setup
from pico.planning.checks.conditions import missed, refused


class Executes(Protocol):
    """What does operations."""

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """See `pico.backends.device.Device`."""
        ...


class Conditioned:
    """A device that begins no operation whose conditions do not hold, and calls none done after which they do not."""

    def __init__(self, setup: Setup, inner: Executes, look: Callable[[], Awaitable[Observation]]) -> None:
        self._setup, self._inner, self._look = setup, inner, look

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; one that requires what is not so fails, and nothing is done."""
        kind = operation.kind
        if kind.requires:
            seen = await self._look()
            if wrong := refused(self._setup, seen, operation):
                return OperationResult(key=key, outcome="failed", error=wrong[0], ended=seen.time)
        result = await self._inner.execute(operation, key, began)
        if not kind.ensures or result.outcome != "done":
            return result
        found = missed(self._setup, await self._look(), operation)
        return result if found is None else replace(result, outcome=found[1], error=found[0])
