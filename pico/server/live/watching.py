"""The benches that are watched: one stream of each from its edge, as long as anybody watches and a little longer."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager, suppress
from typing import Any

from fastapi import FastAPI

from pico.control.leases import Turn
from pico.diagnostics import PicoError, error
from pico.model.record import as_json
from pico.server.live.shown import Shown
from pico.server.live.watcher import Watcher
from pico.server.relay.hub import EdgeLine, Gone, Hub
from pico.server.store.books import Books

LINGERS = 5.0
"""Seconds for which a bench is followed that nobody watches any more: who asked for its scene is about to."""
AWAY = 10.0
"""Seconds in which an edge that is cut off comes back, for who asks for its scene."""
Document = dict[str, Any]


class Watched:
    """A bench that is watched; `shown` while its edge tells."""

    def __init__(self, bench: str, hub: Hub) -> None:
        self.bench, self._hub = bench, hub
        self.shown: Shown | None = None
        self.watchers: set[Watcher] = set()
        self.seq, self.wrong = 0, error("away", f"the edge of {bench} is not connected")
        self.began = asyncio.Event()

    async def follow(self) -> None:
        """Hear what the edge tells, for ever, and tell it who watches."""
        while True:
            with suppress(PicoError):
                await self._followed(await self._hub.line(self.bench, 3600.0))
            self._over()
            await asyncio.sleep(0.2)

    async def _followed(self, line: EdgeLine) -> None:
        number, over = self._hub.number(), asyncio.Event()

        def hear(answer: Mapping[str, Any] | None) -> None:
            if answer is not None and "next" in answer:
                self._heard(answer["next"])  # at once: 30 times a second no task has to wake for it
                return
            if answer is not None and "error" in answer:
                self.wrong = error("live", f"{self.bench} can't be shown: {answer['error'][0]['summary']}")
            over.set()

        try:
            with line.hearing(number, hear):
                await line.told({"id": number, "call": "live", "with": [], "by": {}})
                await over.wait()
        except Gone:
            return
        except asyncio.CancelledError:
            await line.let_go(number)
            raise

    def _heard(self, said: Document) -> None:
        shown = self.shown
        if "scene" in said:
            self.shown = Shown(said["scene"])
            self.began.set()
            for watcher in self.watchers:
                watcher.forget()
            self.tell("scene", {})
        elif shown is not None and "moved" in said:
            frame = shown.moved(said["moved"])
            for watcher in self.watchers:
                watcher.show(frame, shown.whole)
        elif shown is not None:
            shown.told(said["told"], said["rev"], said["data"])
            self.tell(said["told"], said["data"])

    def _over(self) -> None:
        if self.shown is not None:
            self.shown = None
            self.began.clear()
            self.tell("away", {})

    def tell(self, kind: str, data: Document) -> None:
        """Tell who watches what happened."""
        self.seq += 1
        event = {"seq": self.seq, **self.where(), "kind": kind, "data": data}
        text = json.dumps(event, separators=(",", ":"))
        for watcher in self.watchers:
            watcher.tell(text)

    def where(self) -> Document:
        """Return of which scene, and how far: null where the edge does not tell."""
        shown = self.shown
        return {"epoch": shown and shown.epoch, "rev": shown and shown.rev}


class Watching:
    """All benches that are watched."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self._watched: dict[str, tuple[Watched, asyncio.Task[None]]] = {}
        self._users: dict[str, int] = {}
        self._ending: dict[str, asyncio.TimerHandle] = {}

    @asynccontextmanager
    async def bench(self, bench: str) -> AsyncIterator[Watched]:
        """Have a bench followed while the block lasts."""
        if bench not in self._watched:
            made = Watched(bench, self._hub)
            self._watched[bench] = made, asyncio.create_task(made.follow())
        self._users[bench] = self._users.get(bench, 0) + 1
        if (ending := self._ending.pop(bench, None)) is not None:
            ending.cancel()
        try:
            yield self._watched[bench][0]
        finally:
            self._users[bench] -= 1
            if not self._users[bench]:
                self._ending[bench] = asyncio.get_running_loop().call_later(LINGERS, self._end, bench)

    def _end(self, bench: str) -> None:
        self._ending.pop(bench, None)
        self._watched.pop(bench)[1].cancel()

    async def scene(self, bench: str) -> Document:
        """Return the scene of a bench; raises PicoError where its edge is away, or can't tell."""
        async with self.bench(bench) as watched:
            with suppress(TimeoutError):
                async with asyncio.timeout(AWAY):
                    await watched.began.wait()
            if watched.shown is None:
                raise PicoError(watched.wrong)
            return watched.shown.scene()

    def turned(self, bench: str, turn: Turn) -> None:
        """Tell who watches that a lease changed hands."""
        if bench in self._watched:
            for deed in turn.audit:
                self._watched[bench][0].tell("lease", as_json(deed))

    async def close(self) -> None:
        """Follow nothing any more."""
        for ending in self._ending.values():
            ending.cancel()
        tasks = [task for _, task in self._watched.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


@asynccontextmanager
async def watching(app: FastAPI) -> AsyncIterator[None]:
    """Let benches be watched as long as the app serves."""
    books: Books = app.state.books
    found = app.state.watching = Watching(app.state.dispatcher.hub)
    end = books.listen(found.turned)
    try:
        yield
    finally:
        end()
        await found.close()
