"""The coordinator as an ASGI app over its books."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import AsyncIterator, Callable, Collection
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager, suppress
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from starlette.exceptions import HTTPException

from pico.diagnostics import PicoError, error
from pico.plug_ins.faults import blamed
from pico.server.desk.desks import Desking
from pico.server.guard.addresses import LOOPBACK
from pico.server.guard.gatekeeper import Gatekeeper
from pico.server.guard.rates import Rate
from pico.server.guard.saying import document, failure
from pico.server.inner import desking
from pico.server.live.watching import watching
from pico.server.page.serving import page
from pico.server.relay.relaying import relaying
from pico.server.routes.admitting import refusal
from pico.server.routes.known import routers
from pico.server.store.books import Books
from pico.version import __version__

NO_DESKS = Desking()
TICK = 0.5
"""How often leases that are over are looked for [s]."""
Part = Callable[[FastAPI], AbstractAsyncContextManager[None]]
"""What goes on as long as the app serves."""


def create_app(
    books: Books, names: Collection[str] = LOOPBACK, *, parts: Collection[Part] = (), desks: Desking = NO_DESKS
) -> FastAPI:
    """Return the app over some books that answers to `names`; it does not close them. `desks`: how commands are run
    here for those who have no checkout."""

    @asynccontextmanager
    async def lasting(app: FastAPI) -> AsyncIterator[None]:
        await books.do(books.leases.forget)
        async with AsyncExitStack() as stack:
            for part in (_lapsing, relaying, watching, desking, *parts):
                await stack.enter_async_context(part(app))
            yield

    app = FastAPI(
        title="PICO coordinator", version=__version__, lifespan=lasting, docs_url=None, redoc_url=None,
        openapi_url="/api/openapi.json",
    )  # fmt: skip
    app.state.books = books
    app.state.desking = desks
    app.state.sockets, app.state.git = Counter(), Counter()
    app.state.failures, app.state.requests = Rate(5, 30), Rate(200, 1000)
    known, app.state.faults = routers()
    for router in known:
        app.include_router(router)
    app.router.routes.extend(page())
    app.add_middleware(Gatekeeper, names=names)
    app.add_exception_handler(PicoError, _refused)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(Exception, _failed)
    return app


@asynccontextmanager
async def _lapsing(app: FastAPI) -> AsyncIterator[None]:
    books: Books = app.state.books

    async def tick() -> None:
        while True:
            await asyncio.sleep(TICK)
            for bench in await books.look(books.leases.due):
                await books.turn(books.leases.promoted, bench)

    ticking = asyncio.create_task(tick())
    try:
        yield
    finally:
        ticking.cancel()
        with suppress(asyncio.CancelledError):
            await ticking


async def _refused(_: Request, exc: Any) -> Response:
    return refusal(exc)


async def _invalid(_: Request, exc: Any) -> Response:
    found = [error("usage", f"{'.'.join(map(str, finding['loc']))}: {finding['msg']}") for finding in exc.errors()[:10]]
    return JSONResponse(failure(PicoError(found)), 422)


async def _http(_: Request, exc: Any) -> Response:
    body = document(exc.status_code, str(exc.detail))
    return Response(body, exc.status_code, exc.headers, "application/json")


async def _failed(_: Request, exc: Any) -> Response:
    found = blamed(exc) or error("internal", f"the coordinator failed: {type(exc).__name__}")
    return JSONResponse(failure(PicoError(found)), 500)
