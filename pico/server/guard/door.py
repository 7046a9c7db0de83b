"""The socket that a coordinator listens at: it counts who comes, and closes connections that only wait."""

from __future__ import annotations

import asyncio
import errno
import logging
import os
import resource
import socket
import time
from contextlib import suppress
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from pico.server.guard.visits import MOST, RESERVE, Visit, superfluous

VISIT = "pico.visit"
"""Where the scope of a request has its connection's `Visit`."""
_LOOK = 1.0
"""How often connections that are late are looked for [s]."""
_TELL = 60.0
"""How often the log says how many were closed [s]."""
_SHORT = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
_log = logging.getLogger("uvicorn.error")


class _Accepted(socket.socket):
    """A connection that leaves the door's list when it is closed."""

    __slots__ = ("door", "transport", "visit")
    visit: Visit
    door: Door
    transport: asyncio.Transport | None

    def close(self) -> None:
        self.door.left(self)
        super().close()


class Door(socket.socket):
    """A listening socket for asyncio. Its connections are `Visit`s, whose protocols say what they do."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        self._visits: dict[int, _Accepted] = {}
        self._spare = os.open(os.devnull, os.O_RDONLY | os.O_CLOEXEC)
        self._looking: asyncio.TimerHandle | None = None
        self._closed_ones, self._told = 0, float("-inf")

    def accept(self) -> tuple[socket.socket, Any]:
        """Accept a connection, and close another one if there is no room; raises BlockingIOError if none waits."""
        try:
            made, address = super().accept()
        except OSError as exc:
            if exc.errno not in _SHORT:
                raise
            self._run_short()
            raise BlockingIOError(errno.EAGAIN, "no descriptor is free") from None
        found = _Accepted(made.family, made.type, made.proto, fileno=made.detach())
        found.visit = Visit(str(address[0]), time.monotonic())
        found.door, found.transport = self, None
        self._visits[found.fileno()] = found
        self._make_room(found.visit.address)
        if self._looking is None:
            with suppress(RuntimeError):  # outside a loop nothing is served
                self._look(asyncio.get_running_loop())
        return found, address

    def left(self, connection: _Accepted) -> None:
        """Forget a connection that is being closed."""
        if self._visits.get(connection.fileno()) is connection:
            del self._visits[connection.fileno()]

    def close(self) -> None:
        """Listen no more."""
        if self._looking is not None:
            self._looking.cancel()
        if self._spare >= 0:
            os.close(self._spare)
            self._spare = -1
        super().close()

    def _present(self) -> list[Visit]:
        return [connection.visit for connection in self._visits.values()]

    def _leave(self, visit: Visit | None) -> None:
        for connection in [c for c in self._visits.values() if c.visit is visit]:
            self._dismiss(connection)

    def _make_room(self, address: str) -> None:
        """Close a connection if there are too many."""
        soft = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        self._leave(superfluous(self._present(), address, min(MOST, max(soft - RESERVE, soft // 2))))

    def _run_short(self) -> None:
        """Free a descriptor: close a connection that waits, or else refuse the next one, or the loop would spin."""
        found = superfluous(self._present(), "", 0)
        if found is not None:
            self._leave(found)
            return
        if self._spare >= 0:
            os.close(self._spare)
        self._spare = -1
        with suppress(OSError):
            super().accept()[0].close()
            self._count()
        with suppress(OSError):  # another thread took the descriptor: there is no spare one until some are free again
            self._spare = os.open(os.devnull, os.O_RDONLY | os.O_CLOEXEC)

    def _look(self, loop: asyncio.AbstractEventLoop) -> None:
        """Close the connections that are late, and look again as long as there are any."""
        now = time.monotonic()
        waited = 0.0 if self._looking is None else max(0.0, loop.time() - self._looking.when())
        for connection in list(self._visits.values()):
            connection.visit.since += waited  # while the loop was busy, nothing could be read
            if connection.visit.late(now):
                self._dismiss(connection)
        self._tell(now)
        more = self._visits or self._closed_ones
        self._looking = loop.call_later(_LOOK, self._look, loop) if more else None

    def _dismiss(self, connection: _Accepted) -> None:
        self.left(connection)
        self._count()
        if connection.transport is not None:
            connection.transport.abort()
            return
        with suppress(OSError):
            connection.shutdown(socket.SHUT_RDWR)  # in a handshake of TLS, whose transport ends by that

    def _count(self) -> None:
        self._closed_ones += 1
        self._tell(time.monotonic())

    def _tell(self, now: float) -> None:
        """Say how many were closed: the first at once, then once a while."""
        if self._closed_ones and now - self._told >= _TELL:
            these = "a connection that" if self._closed_ones == 1 else f"{self._closed_ones} connections that"
            _log.warning("closed %s sent no whole request in time, or took a place that others needed", these)
            self._closed_ones, self._told = 0, now


class _Visiting:
    """A protocol whose connection came by a `Door`."""

    visit: Visit | None = None
    app: Any
    transport: Any

    def welcome(self, transport: asyncio.BaseTransport) -> None:
        """Find the visit of the connection, and give it to the app in the scope of each request."""
        connection = getattr(transport.get_extra_info("socket"), "_sock", None)
        if isinstance(connection, _Accepted):
            self.visit, connection.transport = connection.visit, self.transport
        app, visit = self.app, self.visit

        async def visited(scope: Any, receive: Any, send: Any) -> None:
            scope[VISIT] = visit
            await app(scope, receive, send)

        self.app = visited


class Requests(H11Protocol, _Visiting):
    """HTTP/1.1: its visit says whether headers, a body, the answer or the next request is waited for."""

    def connection_made(self, transport: Any) -> None:
        """Begin."""
        super().connection_made(transport)
        self.welcome(transport)

    def data_received(self, data: bytes) -> None:
        """Take what came."""
        super().data_received(data)
        if self.visit is None or self.transport.get_protocol() is not self:
            return
        phase = {"IDLE": "headers", "SEND_BODY": "body"}.get(str(self.conn.their_state), "answering")
        self.visit.enter(phase, time.monotonic())  # type: ignore[arg-type]
        self.visit.received += len(data)

    def on_response_complete(self) -> None:
        """Wait for the next request, which uvicorn does for a few seconds."""
        super().on_response_complete()
        if self.visit is not None:
            self.visit.enter("idle", time.monotonic())


class Messages(WebSocketsSansIOProtocol, _Visiting):
    """A WebSocket: its request was whole, so it is never late."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin."""
        super().connection_made(transport)
        self.welcome(transport)
        if self.visit is not None:
            self.visit.enter("answering", time.monotonic())


def raise_limit() -> None:
    """Let this process have as many descriptors as it may."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = 1 << 16 if hard == resource.RLIM_INFINITY else min(hard, 1 << 16)
    if soft != resource.RLIM_INFINITY and soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def mark_known(scope: Any) -> None:
    """Remember that who sent a request has logged in."""
    visit = scope.get(VISIT)
    if visit is not None:
        visit.known = True
