"""The relay as a part of the coordinator's app, as long as that serves."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

from fastapi import FastAPI

from pico.server.relay.dispatch import Dispatcher
from pico.server.relay.hub import Hub
from pico.server.store.books import Books


@asynccontextmanager
async def relaying(app: FastAPI) -> AsyncIterator[None]:
    """Hand calls on to edges, and renew what calls hold."""
    books: Books = app.state.books
    dispatcher = app.state.dispatcher = Dispatcher(books, Hub())
    end = books.listen(dispatcher.turned)
    renewing = asyncio.create_task(dispatcher.renewing())
    try:
        yield
    finally:
        end()
        renewing.cancel()
        with suppress(asyncio.CancelledError):
            await renewing
