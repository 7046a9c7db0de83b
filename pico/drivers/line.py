"""One device at a bus: it is known by its identity, also after the link was lost, and nothing moves after a stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeVar

from pico.diagnostics import PicoError, error
from pico.drivers.bus import USUAL, Bus
from pico.drivers.protocols import Identity

H = TypeVar("H")
T = TypeVar("T")


class Line(Generic[H]):
    """Device `name` at a bus. `identify` asks over an open link who answers; what `expected` says of that (`serial`,
    `model`, `vendor`, `firmware`) is compared before anything else is asked over that link."""

    def __init__(self, name: str, bus: Bus[H], expected: Mapping[Any, str], identify: Callable[[H], Identity]) -> None:
        self.name = name
        self._bus, self._expected, self._identify = bus, expected, identify
        self._known: tuple[H, Identity] | None = None
        self._stops = 0

    @property
    def stops(self) -> int:
        """How often it was stopped: what moves step by step goes on only while this is as it was."""
        return self._stops

    async def connect(self, *, within: float = USUAL) -> Identity:
        """Open the link, and return who answers; raises PicoError where that is somebody else, or takes longer."""
        self._bus.use(self)
        self._known = None
        return await self.ask("say who it is", self._identity, within=within)

    async def ask(self, what: str, run: Callable[[H], T], *, within: float = USUAL) -> T:
        """Return what `run` gives with the link, as `Bus.ask` does."""
        return await self._bus.ask(self.name, what, run, before=self._identity, within=within)

    async def end(self, what: str, run: Callable[[H], T], *, within: float = USUAL) -> T:
        """As `ask`, for what ends light: before all that waits; what was to let light out and has not begun never
        does."""
        self.stopped()
        return await self._bus.ask(self.name, what, run, before=self._identity, within=within, first=True)

    async def move(self, what: str, run: Callable[[H], T], *, within: float = USUAL) -> T:
        """As `ask`, for what moves something or lets light out; raises PicoError where a stop was asked for since."""
        stops = self._stops

        def unless_stopped(link: H) -> T:
            self.require_running(stops, what)
            return run(link)

        return await self._bus.ask(self.name, what, unless_stopped, before=self._identity, within=within)

    async def stop(self, run: Callable[[H], object], *, within: float = USUAL) -> None:
        """Ask for a stop before all that waits; what was asked to move and has not begun never does."""
        self.stopped()
        await self._bus.ask(self.name, "stop", run, before=self._identity, within=within, first=True)

    def stopped(self) -> None:
        """Let nothing begin that was asked for before now, and nothing go on step by step."""
        self._stops += 1

    def require_running(self, stops: int, what: str) -> None:
        """Raise PicoError where it was stopped since `stops` was read."""
        if self._stops != stops:
            raise PicoError(error("device-stopped", f"{self.name} was stopped: {what}", address=self.name))

    async def close(self) -> None:
        """Let go of the bus's link."""
        await self._bus.let_go(self)

    def _identity(self, link: H) -> Identity:
        if self._known is None or self._known[0] is not link:
            found = self._identify(link)
            for key, wanted in self._expected.items():
                if (is_ := getattr(found, key)) != wanted:
                    text = f"another device than {self.name} answers: its {key} is `{is_}`, the lab's is `{wanted}`"
                    hint = "check the address, or write the other one into `identity` if it was exchanged"
                    raise PicoError(error("device-identity", text, hint=hint, address=self.name))
            self._known = link, found
        return self._known[1]
