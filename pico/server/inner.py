"""The door by which commands of desks reach the coordinator: a port of 127.0.0.1, whatever the coordinator listens at
for others, and where they know it by no certificate."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from pathlib import Path
from socket import socket

import uvicorn
from fastapi import FastAPI

from pico.diagnostics import PicoError
from pico.disk import write_whole
from pico.server.desk.desks import Desking, Desks
from pico.server.running import configured, listening
from pico.server.store.books import Books


@asynccontextmanager
async def desking(app: FastAPI) -> AsyncIterator[None]:
    """Have desks, where an app is to have them."""
    books: Books = app.state.books
    wanted: Desking = app.state.desking
    async with _door(app, wanted) as url:
        desks = app.state.desks = Desks(books, wanted, url)
        warming = asyncio.create_task(desks.warm())
        try:
            yield
        finally:
            warming.cancel()
            await asyncio.wait([warming])
            await desks.close()


@asynccontextmanager
async def _door(app: FastAPI, wanted: Desking) -> AsyncIterator[str]:
    """Yield where commands reach an app."""
    if wanted.url or not wanted.warm:
        yield wanted.url
        return
    with _listening(app.state.books.folder) as door:
        serving = _Inner(configured(app, lifespan="off"))
        task = asyncio.create_task(serving.serve(sockets=[door]))
        try:
            yield f"http://127.0.0.1:{door.getsockname()[1]}"
        finally:
            serving.should_exit = True
            await asyncio.wait([task])


class _Inner(uvicorn.Server):
    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals to the server that this one belongs to."""
        yield


def _listening(folder: Path) -> socket:
    """Return a socket at the port of last time where that is free: what commands keep of a bench goes by that."""
    path, before = folder / "port", folder / "desks" / "port"
    if before.is_file():  # where a lab of that name has its desks
        before.replace(path)
    with suppress(OSError, ValueError, PicoError):
        return listening("127.0.0.1", int(path.read_text(encoding="utf-8")))
    found = listening("127.0.0.1", 0)
    write_whole(path, str(found.getsockname()[1]).encode(), folders=True)
    return found
