"""What stands in for an instrument that can't be had: its driver is not installed, or is broken, or has no emulator.
It answers every call with the reason, so that all other devices work."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from pico.diagnostics import Diagnostic, PicoError
from pico.model.quantities import Value


class StandIn:
    """An instrument of any kind whose every method raises PicoError with `why`; a stop and a close do nothing, for
    nothing of it moves."""

    def __init__(self, why: Sequence[Diagnostic]) -> None:
        self.why = tuple(why)

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        """There is no link."""

    def __getattr__(self, name: str) -> Callable[..., Awaitable[Any]]:
        if name.startswith("_"):
            raise AttributeError(name)
        why = self.why

        async def refuse(*args: Any, **kwargs: Any) -> Any:
            raise PicoError(why)

        return refuse


class Lacking:
    """A tunable or measurable of such an instrument."""

    moves = False
    colored = False

    def __init__(self, one: StandIn) -> None:
        self.instrument = one

    async def read(self, wavelength: float | None = None) -> Any:
        """Raise PicoError with the reason."""
        raise PicoError(self.instrument.why)

    async def set(self, value: Value) -> Value:
        """Raise PicoError with the reason."""
        raise PicoError(self.instrument.why)

    async def home(self) -> Value:
        """Raise PicoError with the reason."""
        raise PicoError(self.instrument.why)
