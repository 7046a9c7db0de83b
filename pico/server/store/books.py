"""All that a coordinator keeps, and the one thread that writes it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import ParamSpec, TypeVar

from sqlalchemy.exc import DatabaseError

from pico.control.leases import Turn
from pico.diagnostics import PicoError, error
from pico.disk import writing
from pico.server.store.database import Clock, Database
from pico.server.store.leases import Leases
from pico.server.store.people import People

P = ParamSpec("P")
T = TypeVar("T")
Listener = Callable[[str, Turn], None]
"""Is told of each change of a bench's lease, once it is durable: the bench, and the turn with what is to be said."""


class Books:
    """The books of a coordinator over its database; `folder`: what lies beside it, repositories and large data."""

    def __init__(self, database: Database, folder: Path) -> None:
        self.database, self.folder = database, folder
        self.leases, self.people = Leases(database), People(database)
        self._writer = ThreadPoolExecutor(1, "pico-books")
        self._listeners: list[Listener] = []
        self._watching: list[Callable[[], None]] = []

    async def do(self, work: Callable[P, T], *arguments: P.args, **options: P.kwargs) -> T:
        """Do what waits for the disk, one after the other, while others are answered."""
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._writer, lambda: work(*arguments, **options))

    async def look(self, work: Callable[P, T], *arguments: P.args, **options: P.kwargs) -> T:
        """Read what is there: at once from a file, which waits for no writer, and as `do` from elsewhere."""
        if self.database.local:
            return work(*arguments, **options)
        return await self.do(work, *arguments, **options)

    def listen(self, listener: Listener) -> Callable[[], None]:
        """Have somebody told of changes of leases from now on; return what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def listen_events(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Have somebody told from now on that there are new events; return what ends that."""
        self._watching.append(listener)
        return lambda: self._watching.remove(listener)

    def announce(self) -> None:
        """Tell those who watch that there are new events."""
        for listener in tuple(self._watching):
            listener()

    async def turn(self, work: Callable[P, Turn], *arguments: P.args, **options: P.kwargs) -> Turn:
        """Make a change of a lease (a method of `Leases`), then tell who listens."""
        turn = await self.do(work, *arguments, **options)
        for listener in tuple(self._listeners):
            listener(turn.row.bench, turn)
        self.announce()
        return turn

    def close(self) -> None:
        """Let what is being written end, and let go of the database."""
        self._writer.shutdown()
        self.database.close()


def books_in(folder: Path, clock: Clock | None = None) -> Books:
    """Return the books in a folder, made where there are none; raises PicoError, also where they are damaged."""
    with writing(folder):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        path = folder / "coordinator.sqlite"
        path.touch(mode=0o600)
    url = f"sqlite:///{path}"
    try:
        database = Database(url, clock) if clock else Database(url)
        damaged = database.damaged()
    except DatabaseError as exc:
        damaged = str(exc.orig)
    if damaged:
        hint = (
            f"restore a copy of {folder}; or move it away and begin anew: people log in, and benches enrol, once more"
        )
        raise PicoError(error("books", f"the books of the coordinator in {path} are damaged: {damaged}", hint=hint))
    return Books(database, folder)
