"""Follows an edge for who draws its bench: 30 times a second while something moves, else twice."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

from pico.backends.device import LightGuarded
from pico.backends.hardware.guard.note import notices, read
from pico.diagnostics import Diagnostic
from pico.edge.live import telling
from pico.edge.local import LocalEdge
from pico.model.record import as_json
from pico.model.trace.event import Event
from pico.twin.moment import Moment

Document = dict[str, Any]
MOVING, IDLE = 1 / 30, 0.5
"""Seconds between two looks while something moves, and while nothing does."""
DIM = 0.25
"""Seconds between two looks at the light, at least."""


async def follow(edge: LocalEdge) -> AsyncIterator[Document]:
    """Yield what who draws the bench of an edge is told, for ever (see `telling`), what happens in its runs as
    `{"told": "run"}`, and whenever that changes what the guard has to say as `{"told": "guard"}`. Where the bench looks
    otherwise, by another Lab, it begins anew. Raises PicoError where nobody can tell where things are."""
    following = _Following(edge)
    end = edge.runs.listen(following.hear)
    try:
        while True:
            for document in await following.look():
                yield document
            await following.wait()
    finally:
        end()


class _Following:
    def __init__(self, edge: LocalEdge) -> None:
        self._edge, self._happened = edge, list[Event]()
        self._told: telling.Told | None = None
        self._moving, self._looked, self._lit = False, 0.0, 0.0
        self._noted: tuple[Diagnostic, ...] = ()

    def hear(self, event: Event) -> None:
        """Take in what happened in a run: of its progress the last alone counts."""
        if self._happened and event.kind == self._happened[-1].kind == "operation_progress":
            self._happened.pop()
        self._happened.append(event)

    async def wait(self) -> None:
        """Wait until it is time to look again."""
        loop = asyncio.get_running_loop()
        await asyncio.sleep(max(0.0, self._looked + MOVING - loop.time()))
        while not (self._moving or self._edge.moving() or self._happened) and loop.time() < self._looked + IDLE:
            await asyncio.sleep(MOVING)

    async def look(self) -> list[Document]:
        """Return what is to be told now."""
        loop = asyncio.get_running_loop()
        self._looked = loop.time()
        setup, moment, told = self._edge.setup, await self._edge.sight.moment(), self._told
        if told is None or not telling.drawn_alike(told.setup, setup):
            epoch = secrets.randbits(32)
            self._told, first = await asyncio.to_thread(telling.begun, setup, moment, epoch)
            self._noted = ()
            return [first, *self._guard(), *self._events()]
        told, poses = telling.moved(told, moment)
        told, changes = telling.stood(told, moment)
        self._moving = bool(poses["moved"]["arms"] or poses["moved"]["bodies"])
        if self._looked >= self._lit + DIM:
            told, light = await self._relit(told, moment)
            changes += light
        self._told = told
        return [poses, *changes, *self._guard(), *self._events()]

    async def _relit(self, told: telling.Told, moment: Moment) -> tuple[telling.Told, list[Document]]:
        self._lit = self._looked
        return await asyncio.to_thread(telling.relit, told, moment)

    def _guard(self) -> list[Document]:
        """Return what the guard has to say, if that changed."""
        if not isinstance(self._edge.device, LightGuarded):
            return []
        now = notices(read(self._edge.place))
        if now == self._noted:
            return []
        self._noted, rev = now, 0
        if self._told is not None:
            self._told = replace(self._told, rev=self._told.rev + 1)
            rev = self._told.rev
        return [{"told": "guard", "rev": rev, "data": {"notices": as_json(now)}}]

    def _events(self) -> list[Document]:
        happened, rev = list(self._happened), self._told.rev if self._told is not None else 0
        self._happened.clear()
        return [{"told": "run", "rev": rev, "data": as_json(event)} for event in happened]
