"""The line to an edge in another process: what every line does, and the one through a Unix socket of this machine."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any, Protocol

from pico.diagnostics import error
from pico.edge.link import wire
from pico.edge.protocol import Cut
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace

ANSWER = 60.0
"""Seconds in which an edge answers what it does not have to move for."""
LASTING = frozenset({"execute", "start", "report", "finish", "cancel", "halt", "stop", "adopt", "leave"})
"""Calls that last as long as something moves, or waits for the bench."""


class Line(Protocol):
    """Calls of an edge (`wire.CALLS`) over a line. Each raises PicoError as the edge does, and where it does not
    answer."""

    def call(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives; blocks until then."""
        ...

    async def answer(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives."""
        ...

    async def kept(self, name: str, *arguments: Any) -> tuple[Any, Callable[[], None]]:
        """Return what a call gives, and what lets go of that, as the end of this process does."""
        ...

    def answers(self, name: str, *arguments: Any) -> AsyncIterator[Any]:
        """Yield what a call of a stream gives, one after the other."""
        ...

    def close(self) -> None:
        """Let go of everything that was taken."""
        ...


def gone(exc: Exception) -> Cut:
    """Return what is said where an edge does not answer."""
    hint = "its run goes on by itself, if it lives; `pico status` shows what it did"
    return Cut(error("link", f"the edge does not answer: {str(exc) or 'nothing came in time'}", hint=hint))


def _value(name: str, data: bytes) -> Any:
    if not data:
        raise gone(EOFError("it ended the connection"))
    return wire.read_answer(name, data)[1]


class SocketLine:
    """The line to the edge whose socket is at `path`, for the bench at `place`, if that is told: a
    connection for each call."""

    def __init__(self, path: Path, place: BenchPlace | None = None) -> None:
        self._path, self._place = path, place

    def _written(self, name: str, arguments: tuple[Any, ...]) -> bytes:
        """Return a call as it goes over the line; raises PicoError (exit code LOCKED) where it takes a bench that is
        attached to another worktree."""
        if self._place is not None and name in wire.TAKES:
            require_attached(self._place)
        return wire.call(name, arguments)

    def call(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives; blocks until then."""
        asked = self._written(name, arguments)
        try:
            with socket.socket(socket.AF_UNIX) as link:
                link.settimeout(ANSWER)
                link.connect(str(self._path))
                link.sendall(asked)
                with link.makefile("rb") as answer:
                    data = answer.readline()
        except OSError as exc:
            raise gone(exc) from exc
        return _value(name, data)

    async def answer(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives."""
        asked = self._written(name, arguments)
        reader, writer = await self._connect()
        try:
            writer.write(asked)
            async with asyncio.timeout(None if name in LASTING else ANSWER):
                return _value(name, await reader.readline())
        except OSError as exc:  # a timeout is one
            raise gone(exc) from exc
        finally:
            writer.close()

    async def kept(self, name: str, *arguments: Any) -> tuple[Any, Callable[[], None]]:
        """Return what a call gives, and what ends its connection, whose end says that this process is gone."""
        asked = self._written(name, arguments)
        reader, writer = await self._connect()
        try:
            writer.write(asked)
            return _value(name, await reader.readline()), writer.close
        except BaseException:
            writer.close()
            raise

    async def answers(self, name: str, *arguments: Any) -> AsyncIterator[Any]:
        """Yield what a call of a stream gives, one after the other."""
        asked = self._written(name, arguments)
        reader, writer = await self._connect()
        try:
            writer.write(asked)
            while data := await reader.readline():
                kind, item = wire.read_answer(name, data)
                if kind == "value":
                    return
                yield item
            raise gone(EOFError("it ended the connection"))
        finally:
            writer.close()

    async def _connect(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        try:
            return await asyncio.open_unix_connection(str(self._path), limit=wire.LONGEST)
        except OSError as exc:
            raise gone(exc) from exc

    def close(self) -> None:
        """Nothing: each call has a connection of its own."""
