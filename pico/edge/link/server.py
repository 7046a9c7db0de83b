"""Serves an edge to other processes of the same user: what `pico edge` does.

A run that was started here ends by itself, whoever listens. A lease that a client took is given back once its
connection ends, and what it waits for is waited for no more.
"""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.content.store import store_of
from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import writing
from pico.edge import own_lab
from pico.edge.link import place, wire
from pico.edge.link.pictures import Arrays, look_as_json, packed
from pico.edge.local import LocalEdge, embedded
from pico.edge.protocol import Lease
from pico.model.record import as_json
from pico.vision.calibration import Calibration

FAREWELL = 2.0
"""Seconds in which those who follow a run may ask what became of it, once the edge is to end."""
MINDS = 1.0
"""Seconds between two looks at whether an arming is over."""
READING = frozenset({"events", "report", "film", "describe", "holder", "observe", "unended", "lab", "array"})
"""Calls that are answered until then."""


class Server:
    """Serves `edge` at a socket, until it is closed."""

    def __init__(self, edge: LocalEdge) -> None:
        self._edge = edge
        edge.served()
        self._path = place.make(edge.root)
        self._arrays: Arrays = {}
        self._server: asyncio.Server | None = None
        self._clients: set[asyncio.Task[Any]] = set()
        self._ending = False

    async def open(self) -> None:
        """Begin to serve; raises PicoError where somebody else serves this bench."""
        if place.find(self._edge.root) is not None:
            raise PicoError(error("link", f"the bench in {self._edge.root} is served already"), ExitCode.LOCKED)
        mask = os.umask(0o177)
        try:
            with writing(self._path, what=f"the bench can't be served at {self._path}", code="link"):
                self._path.unlink(missing_ok=True)
                self._server = await asyncio.start_unix_server(self._client, str(self._path), limit=wire.LONGEST)
        finally:
            os.umask(mask)
        place.announce(self._edge.root, self._path)

    async def close(self) -> None:
        """Bring what is under way to its safe end, let who follows it hear what became of it, and serve no more."""
        self._ending = True
        await self._edge.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(FAREWELL):
                while self._clients:
                    await asyncio.sleep(FAREWELL / 20)
        place.withdraw(self._edge.root, self._path)
        if self._server is not None:
            self._server.close()
        for client in self._clients:
            client.cancel()

    async def _client(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._clients.add(task)
        leases: list[Lease] = []
        runs: list[str] = []
        try:
            data = await reader.readline()
            while data:
                answering = asyncio.create_task(self._answer(data, writer, leases, runs))
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
            for lease in leases:
                await self._edge.release(lease)
            for run in runs:
                await self._edge.alone.gone(run)
            writer.close()

    async def _answer(
        self, data: bytes, writer: asyncio.StreamWriter, leases: list[Lease], runs: list[str]
    ) -> None:  # fmt: skip
        with suppress(ConnectionError):
            async for document in self._answers(data, leases, runs):
                writer.write(wire.line(document))
                await writer.drain()

    async def _answers(self, data: bytes, leases: list[Lease], runs: list[str]) -> AsyncIterator[dict[str, Any]]:
        """Yield the lines that answer a call; what it takes for this client is in `leases`, and the unattended `runs`
        that it holds."""
        try:
            name, arguments = wire.read_call(data)
            if self._ending and name not in READING and not name.startswith("memory"):
                raise PicoError(error("link", "the edge is about to end", hint="start it again, then call this again"))
            if name in wire.STREAMS:
                async for item in self._edge.events(*arguments):
                    yield {"next": as_json(item)}
                yield {"value": None}
                return
            found = await self._called(name, arguments)
            if isinstance(found, Lease):
                leases.append(found)
            if name == "hold":
                runs.append(arguments[0].recipe)
            yield {"value": as_json(found)}
        except PicoError as exc:
            yield wire.failure(exc)
        except Exception as exc:  # the others must go on
            yield wire.failure(PicoError(error("internal", f"the edge failed: {type(exc).__name__}: {exc}")))

    async def _called(self, name: str, arguments: list[Any]) -> Any:
        if name == "look":
            return await self._look()
        if name == "array":
            return self._array(*arguments)
        owner, _, method = name.partition(".")
        if owner == "memory":
            return await asyncio.to_thread(self._remembered, method, arguments)
        if owner == "world":
            return await asyncio.to_thread(self._simulated, method, arguments)
        return await getattr(self._edge, name)(*arguments)

    async def _look(self) -> dict[str, Any]:
        document, self._arrays = look_as_json(await self._edge.look())
        return document

    def _array(self, name: str) -> str:
        """Return a picture of the last look, or what a run kept that a commit has no room for."""
        return packed(self._arrays[name] if name in self._arrays else store_of(self._edge.root).get(name))

    def _remembered(self, method: str, arguments: list[Any]) -> Any:
        memory = self._edge.memory
        if not method or memory is None:
            return memory is not None
        if method == "records":
            return memory.records(run=arguments[0], key=arguments[1])
        found = getattr(memory, method)(*arguments)
        return tuple(found) if method == "successes" else found

    def _simulated(self, method: str, arguments: list[Any]) -> Any:
        world = self._edge.world
        if not method:
            return None
        if method == "nudge":
            name, dx, dy, dyaw = arguments
            return world.nudge(name, dx=dx, dy=dy, dyaw=dyaw)
        if method == "bump":
            return world.bump(arguments[0], shift=arguments[1], turn=arguments[2])
        if method == "upset":
            return world.upset(arguments[0], **arguments[1])
        if method == "true_cameras":
            return Calibration(cameras=world.true_cameras()).as_json()
        return getattr(world, method)(*arguments)


async def serve(edge: LocalEdge, ready: Callable[[], None] = lambda: None) -> None:
    """Serve an edge until SIGTERM, SIGINT or SIGHUP; what is under way then comes to its safe end."""
    server, ended = Server(edge), asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    await server.open()
    try:
        ready()
        minding = asyncio.create_task(_mind(edge))
        await ended.wait()
        minding.cancel()
    finally:
        await server.close()


async def _mind(edge: LocalEdge) -> None:
    """Shut a laser when its arming ends though nobody works here: who takes the bench does so, and who has it."""
    while True:
        await asyncio.sleep(MINDS)
        if edge.arming_over():
            with suppress(PicoError):
                await edge.release(await edge.acquire("the end of an arming"))


def edge_of(root: Path, backend: str, fidelity: str | None = None) -> LocalEdge:
    """Return the edge to be served of the lab in `root`, by the Lab that its bench keeps, else by the lab's files;
    without `fidelity` in the lab's own. Raises PicoError."""
    lab = own_lab.read(root) or own_lab.proposed(root)
    setup = own_lab.setup_of(lab)
    return embedded(setup, root, backend, fidelity or setup.lab.sim.fidelity, lab)
