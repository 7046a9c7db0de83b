"""What happens at the benches, in order: one socket for those who watch."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Annotated, Any

from fastapi import APIRouter, Query, WebSocket

from pico.server.routes.admitting import Admitted, admit, books
from pico.server.routes.lasting import lasting, left
from pico.server.store.books import Books
from pico.server.store.ordered import read_events, where

router = APIRouter(prefix="/api")
GLANCE = 1.0
"""How often events are looked for that another coordinator wrote [s]."""


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
    try:
        await lasting(socket, admitted, left(socket), _tell(socket, admitted, held, since, news))
    finally:
        end()


async def _tell(socket: WebSocket, admitted: Admitted, held: Books, since: int, news: asyncio.Event) -> None:
    await socket.send_json({"hello": await held.do(_hello, held)})
    while True:
        news.clear()
        for event in await held.look(_after, held, since):
            since = event["number"]
            if admitted.principal().sees(event["bench"].partition("/")[0]):
                await socket.send_json(event)
        with suppress(TimeoutError):
            async with asyncio.timeout(GLANCE):
                await news.wait()


def _hello(held: Books) -> dict[str, Any]:
    with held.database.writing() as connection:
        return where(connection)


def _after(held: Books, since: int) -> list[dict[str, Any]]:
    with held.database.reading() as connection:
        return list(read_events(connection, since))
