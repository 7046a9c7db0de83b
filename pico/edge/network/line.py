"""The line to an edge through a coordinator: one WebSocket, taken up again where it is cut."""

from __future__ import annotations

import asyncio
import os
import queue
import threading
import time
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from typing import Any

from pico.edge.link import wire
from pico.edge.link.line import ANSWER, LASTING
from pico.edge.network import arrays
from pico.edge.network.remotes import Far
from pico.edge.network.session import begun
from pico.edge.network.socket import Hear, Socket
from pico.edge.network.trouble import Gone, away
from pico.model.record import as_json

PATIENCE = 30.0
"""Seconds in which a coordinator that was there may come back, while somebody waits for an answer."""
PAUSE = 0.25
"""Seconds between two attempts to reach it."""
ONCE = frozenset({"acquire", "open", "hold", "goes_on", "execute", "finish", "leave", "adopt", "jog", "arm"}) | (
    wire.TAKES - {"start"}
)
"""Calls that are not made again by themselves where the line was cut meanwhile."""
BRINGS = frozenset({"report", "execute", "peek", "events"})
"""Calls that speak of arrays."""
BEGINS = frozenset({"start", "open"})
_lines: dict[tuple[str, str], NetworkLine] = {}
_making = threading.Lock()


def line_to(far: Far) -> NetworkLine:
    """Return the line of this process to a bench: there is one, whoever asks."""
    key = (far.remote.url, far.name)
    with _making:
        found = _lines.get(key)
        if found is None or found.process != os.getpid() or found.far != far:
            found = _lines[key] = NetworkLine(far)
        return found


class NetworkLine:
    """The line to the bench `far`; see `pico.edge.link.line.Line`. Connected when it is first needed."""

    def __init__(self, far: Far) -> None:
        self.far, self.process = far, os.getpid()
        self._socket: Socket | None = None
        self._met = False
        self._lock = threading.Lock()

    def call(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives; blocks until then."""
        until = time.monotonic() + PATIENCE
        while True:
            try:
                return self._blocking(name, arguments)
            except Gone:
                if not self._again(name, until):
                    raise
                time.sleep(PAUSE)

    async def answer(self, name: str, *arguments: Any) -> Any:
        """Return what a call gives."""
        until = time.monotonic() + PATIENCE
        while True:
            try:
                value, _ = await self._asked(name, arguments)
                await self._bring(name, value)
                return value
            except Gone:
                if not self._again(name, until):
                    raise
                await asyncio.sleep(PAUSE)

    async def kept(self, name: str, *arguments: Any) -> tuple[Any, Callable[[], None]]:
        """Return what a call gives, and what lets go of that, as the end of this process does."""
        return await self._asked(name, arguments)

    async def answers(self, name: str, *arguments: Any) -> AsyncIterator[Any]:
        """Yield the events of a run, those after the last one where the line was cut meanwhile."""
        run, since = arguments
        until = time.monotonic() + PATIENCE
        while True:
            try:
                async for event in self._stream(name, run, since):
                    since, until = event.seq, time.monotonic() + PATIENCE
                    await self._bring(name, event)
                    yield event
                return
            except Gone:
                if not self._again(name, until):
                    raise
                await asyncio.sleep(PAUSE)

    def close(self) -> None:
        """End the connection; it is made again when it is needed."""
        with self._lock:
            if self._socket is not None and self._socket.process == os.getpid():
                self._socket.close()
            self._socket = None

    async def _bring(self, name: str, value: Any) -> None:
        """Have the arrays here that an answer speaks of."""
        if name not in BRINGS:
            return
        for one in arrays.missing(self.far, arrays.refs(as_json(value))):
            packed, _ = await self._asked("array", (one,))
            await asyncio.to_thread(arrays.keep, self.far, one, packed)

    def _again(self, name: str, until: float) -> bool:
        return self._met and name not in ONCE and time.monotonic() < until

    def _connected(self) -> Socket:
        with self._lock:
            if self._socket is None or self._socket.cut or self._socket.process != os.getpid():
                self._socket = Socket(self.far)
                self._met = True
            return self._socket

    def _send(self, name: str, arguments: tuple[Any, ...], hear: Hear) -> tuple[Socket, int]:
        if name in BEGINS:
            begun(self.far.folder, arguments[1])
        socket = self._connected()
        return socket, socket.send(name, arguments, hear)

    def _blocking(self, name: str, arguments: tuple[Any, ...]) -> Any:
        heard: queue.SimpleQueue[Mapping[str, Any] | Gone] = queue.SimpleQueue()
        self._send(name, arguments, heard.put)
        try:
            return _read(name, heard.get(timeout=None if name in LASTING else ANSWER))[1]
        except queue.Empty:
            raise away(self.far.remote.url, f"no answer to {name}") from None

    async def _asked(self, name: str, arguments: tuple[Any, ...]) -> tuple[Any, Callable[[], None]]:
        heard: asyncio.Queue[Mapping[str, Any] | Gone] = asyncio.Queue()
        socket, number = await asyncio.to_thread(self._send, name, arguments, _into(heard))
        lasting = name in LASTING or name in wire.TAKES
        try:
            async with asyncio.timeout(None if lasting else ANSWER):
                value = _read(name, await heard.get())[1]
        except TimeoutError:
            socket.let_go(number)
            raise away(self.far.remote.url, f"no answer to {name}") from None
        except asyncio.CancelledError:
            socket.let_go(number)
            raise
        return value, lambda: socket.let_go(number)

    async def _stream(self, name: str, run: str, since: int) -> AsyncIterator[Any]:
        heard: asyncio.Queue[Mapping[str, Any] | Gone] = asyncio.Queue()
        socket, number = await asyncio.to_thread(self._send, name, (run, since), _into(heard))
        over = False
        try:
            while not over:
                kind, event = _read(name, await heard.get())
                over = kind == "value"
                if not over:
                    yield event
        finally:
            if not over:
                socket.let_go(number)


def _into(heard: asyncio.Queue[Mapping[str, Any] | Gone]) -> Hear:
    """Return what puts answers, which come in another thread, into a queue of this loop."""
    loop = asyncio.get_running_loop()

    def hear(document: Mapping[str, Any] | Gone) -> None:
        with suppress(RuntimeError):  # the loop is over, and nobody waits any more
            loop.call_soon_threadsafe(heard.put_nowait, document)

    return hear


def _read(name: str, document: Mapping[str, Any] | Gone) -> tuple[str, Any]:
    if isinstance(document, Gone):
        raise document
    return wire.read_document(name, document)
