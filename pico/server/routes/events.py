"""What happens at the benches, in order: one socket for those who watch."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Annotated, Any

from fastapi import APIRouter, Query, WebSocket, WebSocketDisconnect

from pico.diagnostics import PicoError
from pico.server.guard.saying import failure
from pico.server.routes.admitting import Admitted, admit, books
from pico.server.store.books import Books
from pico.server.store.ordered import read_events, where

router = APIRouter(prefix="/api")
GLANCE = 1.0
"""How often events are looked for that another coordinator wrote [s]."""
OVER = 4401
"""Code with which a socket is closed whose token is over."""


@router.websocket("/events")
async def events(socket: WebSocket, since: Annotated[int, Query(ge=0, le=2**53)] = 0) -> None:
    """Tell what happened after number `since` and what happens from now on, of the labs in which one has a role.

    First `hello` with the `epoch` and the last `number`: where the epoch is another than before, or the number below
    `since`, the books are others than those that were watched.
    """
    admitted = await admit(socket, "known")
    if admitted is None:
        return
    held = books(socket.app)
    news = asyncio.Event()
    end = held.listen_events(news.set)
    await socket.accept()
    leaving = asyncio.create_task(_left(socket))
    telling = asyncio.create_task(_tell(socket, admitted, held, since, news))
    try:
        await asyncio.wait([leaving, telling], return_when=asyncio.FIRST_COMPLETED)
    finally:
        end()
        for task in (leaving, telling):
            task.cancel()
        await asyncio.gather(leaving, telling, return_exceptions=True)


async def _left(socket: WebSocket) -> None:
    """Wait until a socket is closed; what it says meanwhile counts for nothing."""
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass


async def _tell(socket: WebSocket, admitted: Admitted, held: Books, since: int, news: asyncio.Event) -> None:
    with suppress(WebSocketDisconnect, RuntimeError):
        try:
            await socket.send_json({"hello": await held.do(_hello, held)})
            while True:
                news.clear()
                for event in await held.look(_after, held, since):
                    since = event["number"]
                    if admitted.principal().sees(event["bench"].partition("/")[0]):
                        await socket.send_json(event)
                admitted.principal()
                with suppress(TimeoutError):
                    async with asyncio.timeout(GLANCE):
                        await news.wait()
        except PicoError as exc:
            await socket.send_json(failure(exc))
            await socket.close(OVER)


def _hello(held: Books) -> dict[str, Any]:
    with held.database.writing() as connection:
        return where(connection)


def _after(held: Books, since: int) -> list[dict[str, Any]]:
    with held.database.reading() as connection:
        return list(read_events(connection, since))
