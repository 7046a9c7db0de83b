"""Serves an edge to other processes of the same user: what `pico edge` does.

A run that was started here ends by itself, whoever listens. A lease that a client took is given back once its
connection ends, and what it waits for is waited for no more.
"""

from __future__ import annotations

import asyncio
import gc
import os
import signal
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import nullcontext, suppress
from typing import Any

from pico.backends.devices import HARDWARE
from pico.backends.hardware.guard.note import Ended
from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import writing
from pico.edge import own_lab
from pico.edge.lease import enrolled
from pico.edge.link import place, wire
from pico.edge.link.answering import Answering, Taken
from pico.edge.local import LocalEdge, embedded
from pico.places.bench import BenchPlace
from pico.places.lab import lenient

FAREWELL = 2.0
"""Seconds in which those who follow a run may ask what became of it, once the edge is to end."""
MINDS = 1.0
"""Seconds between two looks at whether an arming is over."""
SAFER = frozenset({"disarm"})
"""Calls that only make the bench safer: whoever grants the bench, they are answered here, too."""
READING = frozenset({"events", "report", "film", "describe", "holder", "observe", "unended", "lab", "array"})
"""Calls that are answered until then."""
DARKENING = SAFER | READING | {"armings", "end_light", "halt", "stop"}
"""Calls by which light is ended, and is seen to be: no symbolic link in `.pico` keeps an edge from them."""


class Server:
    """Serves `edge` at a socket, until it is closed."""

    def __init__(self, edge: LocalEdge) -> None:
        self._edge = edge
        edge.lock.server = True
        self._path = place.make(edge.place)
        self._answering = Answering(edge)
        self._server: asyncio.Server | None = None
        self._clients: set[asyncio.Task[Any]] = set()
        self._ending = False

    @property
    def has_clients(self) -> bool:
        """Whether a client is connected."""
        return bool(self._clients)

    async def open(self) -> None:
        """Begin to serve; raises PicoError where somebody else serves this bench."""
        if place.find(self._edge.place) is not None:
            raise PicoError(
                error(
                    "link",
                    f"the bench `{self._edge.place.name}` in {self._edge.place.root} is served already",
                    hint="by another `pico edge`, or by the guard of its lasers, which ends soon after all are dark",
                ),
                ExitCode.LOCKED,
            )
        mask = os.umask(0o177)
        try:
            with writing(self._path, what=f"the bench can't be served at {self._path}", code="link"):
                self._path.unlink(missing_ok=True)
                self._server = await asyncio.start_unix_server(self._client, str(self._path), limit=wire.LONGEST)
        finally:
            os.umask(mask)
        place.announce(self._edge.place, self._path)

    async def close(self) -> None:
        """Bring what is under way to its safe end, let who follows it hear what became of it, and serve no more."""
        self._ending = True
        await self._edge.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(FAREWELL):
                while self._clients:
                    await asyncio.sleep(FAREWELL / 20)
        place.withdraw(self._edge.place, self._path)
        if self._server is not None:
            self._server.close()
        for client in self._clients:
            client.cancel()

    async def _client(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._clients.add(task)
        taken = Taken()
        try:
            data = await reader.readline()
            while data:
                answering = asyncio.create_task(self._answer(data, writer, taken))
                more = asyncio.create_task(reader.readline())  # who waits for an answer says nothing, or is gone
                await asyncio.wait([answering, more], return_when=asyncio.FIRST_COMPLETED)
                if not answering.done():
                    answering.cancel()
                    await asyncio.wait([answering])
                data = await more
        except (ConnectionError, ValueError, asyncio.CancelledError):  # it is gone, or says what nobody reads
            pass
        finally:
            self._clients.discard(task)
            await taken.let_go(self._edge)
            writer.close()

    async def _answer(self, data: bytes, writer: asyncio.StreamWriter, taken: Taken) -> None:
        with suppress(ConnectionError):
            async for document in self._answers(data, taken):
                writer.write(wire.line(document))
                await writer.drain()

    async def _answers(self, data: bytes, taken: Taken) -> AsyncIterator[dict[str, Any]]:
        """Yield the lines that answer a call."""
        try:
            name, arguments = wire.read_call(data)
            if self._ending and name not in READING and not name.startswith("memory"):
                raise PicoError(error("link", "the edge is about to end", hint="start it again, then call this again"))
            if name in (wire.TAKES | wire.HOLDS) - SAFER and self._edge.enrolled:
                raise PicoError(enrolled(self._edge.place.folder), ExitCode.LOCKED)
        except PicoError as exc:
            yield wire.failure(exc)
            return
        with lenient() if name in DARKENING else nullcontext():
            async for document in self._answering.answers(name, arguments, taken):
                yield document


async def serve(
    edge: LocalEdge, ready: Callable[[], None] = lambda: None,
    beside: Callable[[], Coroutine[Any, Any, None]] | None = None,
    idle: Callable[[bool], bool] | None = None,
) -> None:  # fmt: skip
    """Serve an edge until SIGTERM, SIGINT or SIGHUP, or until `idle` says that nothing needs it any more, which is
    asked with whether a client is connected; what is under way then comes to its safe end, and light of a real bench
    ends, for nothing guards it any more. `beside`: what goes on meanwhile."""
    server, ended = Server(edge), asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    await server.open()
    gc.collect()
    gc.freeze()  # what is loaded by now stays: nobody looks through it for garbage while others wait
    try:
        ready()
        tasks = [asyncio.create_task(_mind(edge)), *([asyncio.create_task(beside())] if beside else ())]
        if idle is not None:
            tasks.append(asyncio.create_task(_until_idle(server, idle, ended)))
        await ended.wait()
        for task in tasks:
            task.cancel()
    finally:
        if edge.place.name == HARDWARE and edge.leaves_light():  # from now on nobody would guard it
            with suppress(PicoError):
                await edge.end_light(at_end=True)
        await server.close()


async def _until_idle(server: Server, idle: Callable[[bool], bool], ended: asyncio.Event) -> None:
    while not idle(server.has_clients):
        await asyncio.sleep(MINDS / 2)
    ended.set()


async def _mind(edge: LocalEdge) -> None:
    """Shut a laser when its arming ends though nobody works here: who takes the bench does so, and who has it."""
    while True:
        await asyncio.sleep(MINDS)
        if edge.licensing.arming_over():
            with suppress(PicoError):
                await edge.release(await edge.acquire("the end of an arming"))


def edge_of(bench: BenchPlace, fidelity: str | None = None) -> LocalEdge:
    """Return the edge of a bench to be served, by the Lab that its bench keeps, else by the lab's files;
    without `fidelity` in the lab's own. Raises PicoError."""
    lab = own_lab.read(bench) or own_lab.proposed(bench.root)
    setup = own_lab.setup_of(lab)
    return embedded(setup, bench, fidelity or setup.lab.sim.fidelity, lab)


async def end_light_of(bench: BenchPlace) -> Ended | None:
    """End all light of a bench that no process serves, and return what became of each laser; None if it emits nothing.
    Raises PicoError if that can't even be tried."""
    edge = edge_of(bench)
    try:
        return await edge.end_light()
    finally:
        await edge.close()
