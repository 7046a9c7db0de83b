"""The first that hears of a request, as ASGI: refuses wrong hosts and origins, and bodies that are too long."""

from __future__ import annotations

from collections.abc import Callable, Collection, MutableMapping
from typing import Any

from starlette.exceptions import HTTPException

from pico.server.guard.addresses import host_of, same_origin
from pico.server.guard.saying import document

BODY = 1 << 20
"""Bytes that a body may have."""
LONG_BODY = 16 << 20
"""Bytes of one that carries a plan or a lab."""
DATA = 64 << 20
"""Bytes of a push, or of large data."""
_LONG = ("/calls/start", "/calls/open", "/calls/adopt")
_HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"cache-control", b"no-store"),
    (b"referrer-policy", b"no-referrer"),
    (b"content-security-policy", b"default-src 'none'; frame-ancestors 'none'"),
)
Scope = MutableMapping[str, Any]
OVER = "pico.over"
"""Where a request's scope has what is done once it is over."""


class Gatekeeper:
    """Stands before an ASGI app that answers to `names`."""

    def __init__(self, app: Any, names: Collection[str]) -> None:
        self._app, self._names = app, frozenset(names)

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        """Answer a request, or hand it on."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers: dict[bytes, list[str]] = {}
        for key, value in scope["headers"]:
            headers.setdefault(key.lower(), []).append(value.decode("latin-1"))
        if refused := self._refused(scope, headers):
            await _answer(scope, send, *refused)
            return
        over: list[Callable[[], None]] = []
        scope[OVER] = over
        try:
            await _Bounded(self._app, longest(scope["path"]))(scope, receive, send)
        finally:
            for done in over:
                done()

    def _refused(self, scope: Scope, headers: dict[bytes, list[str]]) -> tuple[int, str] | None:
        hosts = headers.get(b"host", [])
        found = host_of(hosts[0], scope["scheme"]) if len(hosts) == 1 else None
        if found is None or found[0] not in self._names:
            return 421, "this is not a name of this coordinator (`pico serve --name` gives it one)"
        for origin in headers.get(b"origin", []):
            if not same_origin(origin, hosts[0]):
                return 403, "pages of other hosts may not speak to this coordinator"
        length = headers.get(b"content-length", ["0"])[0]
        if not length.isdigit() or int(length) > longest(scope["path"]):
            return 413, f"a body has {longest(scope['path'])} bytes at most"
        return None


def longest(path: str) -> int:
    """Return how many bytes the body of a request to `path` may have."""
    if path.endswith("/git-receive-pack") or "/objects/" in path:
        return DATA
    return LONG_BODY if path.endswith(_LONG) else BODY


class _Bounded:
    """Counts what comes in, also where no length was said, and adds the headers that every answer has which says
    no other ones."""

    def __init__(self, app: Any, limit: int) -> None:
        self._app, self._limit = app, limit

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        count = 0

        async def counted() -> Any:
            nonlocal count
            message = await receive()
            if message["type"] == "http.request":
                count += len(message.get("body", b""))
                if count > self._limit:
                    raise HTTPException(413, f"a body has {self._limit} bytes at most")
            return message

        async def marked(message: Any) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                said = list(message.get("headers", ()))
                names = {name.lower() for name, _ in said}
                message["headers"] = [*said, *(header for header in _HEADERS if header[0] not in names)]
            await send(message)

        await self._app(scope, counted, marked)


async def _answer(scope: Scope, send: Any, status: int, text: str) -> None:
    kind = "websocket.http.response" if scope["type"] == "websocket" else "http.response"
    body = document(status, text)
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode()), *_HEADERS]
    await send({"type": f"{kind}.start", "status": status, "headers": headers})
    await send({"type": f"{kind}.body", "body": body})
