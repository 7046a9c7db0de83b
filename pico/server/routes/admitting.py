"""Who is let in: before a body is read, each route and each socket asks for a token and a role.

A route says its role as `x-pico-role` in what OpenAPI tells of it (`public` asks for nothing), and none can be made
without.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections import Counter
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Coroutine, Iterator
from contextlib import contextmanager
from typing import Any

from fastapi import APIRouter, FastAPI, Request, Response, WebSocket
from fastapi.routing import APIRoute
from starlette.requests import HTTPConnection
from starlette.responses import JSONResponse

from pico.diagnostics import PicoError, error
from pico.server.access.principal import Principal, unauthenticated
from pico.server.access.secret import bearer
from pico.server.guard.door import mark_known
from pico.server.guard.gatekeeper import OVER
from pico.server.guard.rates import Rate
from pico.server.guard.saying import failure, status_of
from pico.server.store.books import Books

ROLE = "x-pico-role"
URGENT = ("/calls/stop", "/calls/halt", "/calls/end_light")
"""Paths that are answered however often somebody asks."""
SOCKETS = 100
"""How many sockets a principal may have open at a time."""
FRESH = 1.0
"""How long a socket goes by what a token let it do, before it asks again [s]."""


class Guarded(APIRoute):
    """A route that lets nobody in without its role, in the lab that its path names, else in all."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return what answers a request."""
        role = (self.openapi_extra or {})[ROLE]
        answer = super().get_route_handler()

        async def admitted(request: Request) -> Response:
            try:
                if role != "public":
                    principal = await authenticated(request)
                    principal.require(role, request.path_params.get("lab", "*"))
                    request.state.principal = principal
                return await answer(request)
            except PicoError as exc:
                return refusal(exc, "Basic realm=PICO" if "/git/" in request.url.path else "Bearer")

        return admitted


def routed() -> APIRouter:
    """Return a router whose routes are all guarded."""
    return APIRouter(prefix="/api", route_class=Guarded)


def needs(role: str) -> dict[str, Any]:
    """Return what a route is made with that asks for a role: `known` for any token, `any` for any role in its lab."""
    return {"openapi_extra": {ROLE: role} | ({} if role == "public" else {"security": [{"bearer": []}]})}


def refusal(exc: PicoError, scheme: str = "Bearer") -> Response:
    """Return the answer that says what went wrong, and by which scheme one is to say who one is."""
    status = status_of(exc)
    return JSONResponse(failure(exc), status, {"www-authenticate": scheme} if status == 401 else None)


def books(app: FastAPI | Any) -> Books:
    """Return the books of an app."""
    found: Books = app.state.books
    return found


async def authenticated(connection: HTTPConnection) -> Principal:
    """Return whose token a request carries; raises PicoError (status 401), and 429 for who asks too often."""
    with guessing(connection):
        found = whose(connection)
        if found is None:
            raise unauthenticated()
    mark_known(connection.scope)
    if not connection.headers.get("authorization"):
        _require_origin(connection)
    urgent = connection.url.path.endswith(URGENT)
    if not urgent and not connection.app.state.requests.taken(found.name, time.monotonic()):
        raise _too_often()
    return found


def whose(connection: HTTPConnection) -> Principal | None:
    """Return whom a request's token, else its session of a browser, lets in; None where there is none that does."""
    people, header = books(connection.app).people, connection.headers.get("authorization")
    if header:
        secret = bearer(header)
        return people.known(secret) if secret else None
    session = session_of(connection)
    return people.seated(session) if session else None


def session_of(connection: HTTPConnection) -> str:
    """Return the session of a browser that a request carries; empty where there is none."""
    return connection.cookies.get(cookie_name(connection), "")


def cookie_name(connection: HTTPConnection) -> str:
    """Return what the cookie of a session is called: browsers do not tell ports of a host apart."""
    return f"pico_session_{connection.url.port or connection.url.scheme}"


def _require_origin(connection: HTTPConnection) -> None:
    """Raise PicoError (status 403) for what a browser does in the name of its session and does not say for which page:
    an Origin that is said is this host (see `Gatekeeper`)."""
    looks = connection.scope["type"] == "http" and connection.scope["method"] in ("GET", "HEAD", "OPTIONS")
    if not looks and not connection.headers.get("origin"):
        text = "with a session of a browser this needs an Origin"
        raise PicoError(error("forbidden", text, hint="a program sends its token: `Authorization: Bearer ...`"))


@contextmanager
def guessing(connection: HTTPConnection) -> Iterator[None]:
    """Ask for a secret; raises PicoError (status 429) for a wrong one where too many came from the same address. Who
    has the right one is let in whatever others try from there: a proxy may be the address of all."""
    address = connection.client.host if connection.client else ""
    failures: Rate = connection.app.state.failures
    try:
        yield
    except PicoError:
        if not failures.taken(address, time.monotonic()):
            raise _too_often() from None
        raise


def _too_often() -> PicoError:
    return PicoError(error("limit", "too many requests at once", hint="ask again in a second, and less often"))


class Admitted:
    """Whom a socket or a long answer let in, asked for again while it lasts: a token that is revoked ends here, too."""

    def __init__(self, socket: HTTPConnection, principal: Principal) -> None:
        self._socket, self._principal, self._asked = socket, principal, time.monotonic()

    def principal(self) -> Principal:
        """Return the principal, with what it may now; raises PicoError (status 401) once its token is over."""
        if time.monotonic() - self._asked > FRESH:
            found = whose(self._socket)
            if found is None:
                raise unauthenticated()
            self._principal, self._asked = found, time.monotonic()
        return self._principal


async def while_known(
    connection: HTTPConnection, principal: Principal, lines: AsyncIterator[bytes]
) -> AsyncIterator[bytes]:  # fmt: skip
    """Yield what a long answer says, a line each, as long as the token lasts; then that it does not."""
    admitted = Admitted(connection, principal)
    following: asyncio.Future[bytes] | None = None
    try:
        while True:
            following = asyncio.ensure_future(anext(lines))
            while not (await asyncio.wait([following], timeout=FRESH))[0]:
                admitted.principal()
            admitted.principal()
            yield following.result()
    except StopAsyncIteration:
        pass
    except PicoError as exc:
        yield json.dumps(failure(exc), separators=(",", ":")).encode() + b"\n"
    finally:
        if following is not None and not following.done():
            following.cancel()
            await asyncio.wait([following])
        if isinstance(lines, AsyncGenerator):
            await lines.aclose()


def _count(socket: WebSocket, name: str) -> None:
    """Count a socket of a principal until it is over; raises PicoError (status 429) for one too many."""
    sockets: Counter[str] = socket.app.state.sockets
    if sockets[name] >= SOCKETS:
        text = f"{name} has {SOCKETS} sockets open, and may have no more"
        raise PicoError(error("limit", text, hint="close pages and clients that are not needed"))

    def over() -> None:
        sockets[name] -= 1

    sockets[name] += 1
    socket.scope[OVER].append(over)


async def admit(socket: WebSocket, role: str, lab: str = "*") -> Admitted | None:
    """Let a socket in (it is not accepted yet), or answer why not and return None."""
    try:
        principal = await authenticated(socket)
        principal.require(role, lab)
        _count(socket, principal.name)
        return Admitted(socket, principal)
    except PicoError as exc:
        await socket.send_denial_response(refusal(exc))
        return None
