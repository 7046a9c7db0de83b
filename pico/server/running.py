"""A coordinator that listens, until it is told to end."""

from __future__ import annotations

import asyncio
import gc
import logging
import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import uvicorn

from pico.diagnostics import ExitCode, PicoError, error
from pico.server.guard.addresses import require_safe
from pico.server.guard.door import Door, Messages, Requests, raise_limit

PING = 2.0
"""How often a socket's other end is asked whether it is there, well within the time that a lease lasts [s]."""
LONGEST = 64 << 20
"""Bytes of a message: an edge may answer with pictures."""


def listening(host: str, port: int, *, tls: bool = False) -> socket.socket:
    """Return a socket that listens at an address, port 0 for a free one; raises PicoError for one that others reach
    without TLS, and where something else listens."""
    require_safe(host, tls=tls)
    try:
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        with socket.create_server((host, port), family=family, backlog=256) as plain:
            made = Door(plain.family, plain.type, plain.proto, fileno=plain.detach())
    except OSError as exc:
        text = f"the coordinator can't listen at {host}, port {port}: {exc.strerror or exc}"
        raise PicoError(error("listen", text, hint="`--port` takes another one"), ExitCode.LOCKED) from exc
    made.set_inheritable(False)
    # what is accepted has it from here: asyncio sets it for sockets only that say they are TCP's by their number, and
    # without it a second message in a row waits up to 40 ms for the first one to be acknowledged
    made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return made


def server(app: Any, certificate: Path | None = None, key: Path | None = None) -> uvicorn.Server:
    """Return what serves an app on sockets (`server.serve(sockets=[...])`) until SIGINT or SIGTERM; raises PicoError
    for a certificate or key that can't be used."""
    raise_limit()
    config = configured(app, ssl_certfile=certificate, ssl_keyfile=key)
    try:
        config.load()
    except (OSError, ValueError) as exc:
        raise _unusable(certificate, key, exc) from exc
    return _Server(config, app)


def _unusable(certificate: Path | None, key: Path | None, why: Exception) -> PicoError:
    hint = "`--certificate` and `--key` name files in PEM form, which belong together"
    for file in (certificate, key):
        if file is not None and not file.is_file():
            return PicoError(error("tls", f"there is no file {file}", hint=hint))
    both = f"certificate {certificate} and key {key}" if key else f"certificate {certificate}, in which a key must be"
    return PicoError(error("tls", f"TLS does not take the {both}: {why}", hint=hint))


def configured(app: Any, **more: Any) -> uvicorn.Config:
    """Return how an app is served."""
    found = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False, date_header=False, http=Requests, ws=Messages,
        backlog=256, ws_ping_interval=PING, ws_ping_timeout=PING * 1.5, ws_max_size=LONGEST,
        ws_per_message_deflate=False, timeout_graceful_shutdown=3, h11_max_incomplete_event_size=1 << 16, **more,
    )  # fmt: skip
    logging.getLogger("uvicorn.error").addFilter(_is_news)
    return found


def _is_news(record: logging.LogRecord) -> bool:
    """Return whether a line of the log says something: uvicorn takes each socket that was refused for a mistake."""
    return "without completing handshake" not in record.getMessage()


class _Server(uvicorn.Server):
    def __init__(self, config: uvicorn.Config, app: Any) -> None:
        super().__init__(config)
        self._app = app

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End. What goes on at desks is ended first, as Ctrl-C does, while it and the edges still have their lines: a
        run halts so, and a part in the hand is set down. A second signal does not wait for that."""
        if desks := getattr(self._app.state, "desks", None):
            ending = asyncio.create_task(desks.close())
            while not ending.done() and not self.force_exit:
                await asyncio.wait([ending], timeout=0.1)
        await super().shutdown(sockets)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin; what is loaded by now stays, and nobody looks through it for garbage while others wait."""
        await super().startup(sockets)
        gc.collect()
        gc.freeze()

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Let SIGINT and SIGTERM end the serving, and nothing else: it has ended then as it should."""
        loop, taken = asyncio.get_running_loop(), []
        if threading.current_thread() is threading.main_thread():
            taken = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
        for number in taken:
            loop.add_signal_handler(number, self.handle_exit, number, None)
        try:
            yield
        finally:
            for number in taken:
                loop.remove_signal_handler(number)
