"""The edges that are connected now, a line each: calls go out over it, answers come back by their numbers."""

from __future__ import annotations

import asyncio
import itertools
import secrets
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import Any

from pico.diagnostics import PicoError, error
from pico.edge.network.messages import is_last

Document = Mapping[str, Any]
Send = Callable[[Document], Awaitable[None]]
CLOSING = 30.0
"""Seconds in which an edge lets go of what a call took: what moves comes to its safe end meanwhile."""


class Gone(Exception):
    """The edge was cut off before it answered."""


class EdgeLine:
    """A connected edge of a bench; `hello`: what it said of itself, `fenced`, `moving` and `hindered` (from
    fencing for a lease, in words) what it said last."""

    def __init__(self, bench: str, hello: Document, send: Send) -> None:
        self.bench, self.hello, self._send = bench, hello, send
        self.fenced, self.moving, self.hindered = int(hello["fenced"]), "", ""
        self.over = asyncio.Event()
        self._waiting: dict[str, Callable[[Document | None], None]] = {}

    async def told(self, document: Document) -> None:
        """Say something; raises Gone."""
        if self.over.is_set():
            raise Gone
        try:
            await self._send(document)
        except Exception as exc:  # whatever the server's socket raises for one that is gone
            self.end()
            raise Gone from exc

    async def answers(self, call: str, document: Document) -> AsyncIterator[Document]:
        """Send a call and yield its answers; raises Gone where the edge is cut off meanwhile."""
        answers: asyncio.Queue[Document | None] = asyncio.Queue()
        with self.hearing(call, answers.put_nowait):
            await self.told({"id": call, **document})
            while True:
                answer = await answers.get()
                if answer is None:
                    raise Gone
                yield answer
                if is_last(answer):
                    return

    @contextmanager
    def hearing(self, call: str, hear: Callable[[Document | None], None]) -> Iterator[None]:
        """Have the answers to a call heard at once, while the block lasts: None where the edge is cut off."""
        self._waiting[call] = hear
        try:
            yield
        finally:
            if self._waiting.get(call) is hear:
                del self._waiting[call]

    async def let_go(self, call: str) -> None:
        """Have the edge let go of what a call took, and wait until it has; where it is cut off it does so itself."""
        answers: asyncio.Queue[Document | None] = asyncio.Queue()
        with self.hearing(call, answers.put_nowait), suppress(Gone, TimeoutError):
            await self.told({"id": call, "close": True})
            async with asyncio.timeout(CLOSING):
                while (answer := await answers.get()) is not None and "closed" not in answer:
                    pass

    def heard(self, said: dict[str, Any]) -> None:
        """Hear an answer."""
        waiting = self._waiting.get(str(said.pop("id", "")))
        if waiting is not None:
            waiting(said)

    def end(self) -> None:
        """Hear that the edge is cut off."""
        self.over.set()
        for waiting in tuple(self._waiting.values()):
            waiting(None)


class Hub:
    """The lines by bench."""

    def __init__(self) -> None:
        self._lines: dict[str, EdgeLine] = {}
        self._news = asyncio.Event()
        self._prefix, self._count = secrets.token_hex(4), itertools.count(1)

    def number(self) -> str:
        """Return what a call is known by, which no other one ever is."""
        return f"{self._prefix}-{next(self._count)}"

    def joined(self, line: EdgeLine) -> None:
        """Take a line in place of the one that its bench had."""
        if (before := self._lines.get(line.bench)) is not None:
            before.end()
        self._lines[line.bench] = line
        self._news.set()
        self._news = asyncio.Event()

    def left(self, line: EdgeLine) -> None:
        """Hear that a line is over."""
        line.end()
        if self._lines.get(line.bench) is line:
            del self._lines[line.bench]

    def connected(self, bench: str) -> EdgeLine | None:
        """Return the line of a bench; None where its edge is away."""
        line = self._lines.get(bench)
        return None if line is None or line.over.is_set() else line

    async def line(self, bench: str, seconds: float) -> EdgeLine:
        """Return the line of a bench, waiting so long for its edge; raises PicoError where it stays away."""
        try:
            async with asyncio.timeout(seconds):
                while (found := self.connected(bench)) is None:
                    await self._news.wait()
                return found
        except TimeoutError:
            hint = (
                "`pico edge` beside the table connects it; what it was doing goes on by itself, up to its lease's end"
            )
            raise PicoError(error("away", f"the edge of {bench} is not connected", hint=hint)) from None

    async def hinted(self, bench: str, token: int) -> None:
        """Have the edge of a bench ask at once for its lease, which changed."""
        if (line := self.connected(bench)) is not None:
            with suppress(Gone):
                await line.told({"lease": {"token": token, "left": 0}})
