"""One WebSocket to a coordinator, with many calls on their way at a time."""

from __future__ import annotations

import json
import os
import ssl
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from itertools import count
from typing import Any

from pico.diagnostics import PicoError
from pico.edge.link import wire
from pico.edge.network.remotes import Far, Remote
from pico.edge.network.session import session_in
from pico.edge.network.tokens import certificate_of, token_of
from pico.edge.network.trouble import Gone, away, missing_extra, refused, untrusted
from pico.version import __version__

Hear = Callable[[Mapping[str, Any] | Gone], None]
"""What is told each answer to a call, and that the line is cut."""
OPENING = 5.0
"""Seconds in which a coordinator answers at all."""


class Socket:
    """A WebSocket to the bench `far`; raises PicoError where it can't be had."""

    def __init__(self, far: Far) -> None:
        self._url = far.remote.url
        self.process = os.getpid()
        self._opened, self._socket = _connected(far)
        self._calls: dict[int, Hear] = {}
        self._numbers, self._lock = count(1), threading.Lock()
        self.cut: Gone | None = None
        threading.Thread(target=self._read, name="pico network", daemon=True).start()

    def send(self, name: str, arguments: Sequence[Any], hear: Hear) -> int:
        """Call; `hear` is told what comes of it, in another thread. Return the number of the call."""
        number = next(self._numbers)
        with self._lock:
            if self.cut is not None:
                raise self.cut
            self._calls[number] = hear
        document = json.loads(wire.call(name, tuple(arguments)))
        self._say({"id": number, **document})
        return number

    def let_go(self, number: int) -> None:
        """Say that nobody wants any more what a call took, or follows."""
        self._calls.pop(number, None)
        with suppress(Gone):
            self._say({"id": number, "close": True})

    def close(self) -> None:
        """End the connection; whoever is at the other end lets go of what was taken."""
        with suppress(Exception):
            self._opened.close()

    def _say(self, document: Mapping[str, Any]) -> None:
        from websockets.exceptions import ConnectionClosed

        try:
            self._socket.send(json.dumps(document, separators=(",", ":")))
        except (ConnectionClosed, OSError) as exc:
            raise self._away(exc) from exc

    def _read(self) -> None:
        why: Exception = EOFError("it ended the connection")
        try:
            for data in self._socket:
                document = json.loads(data)
                self._hand_on(document)
        except Exception as exc:  # whatever it was, nothing more is read
            why = exc
        with self._lock:
            self.cut = self._away(why)
            waiting, self._calls = list(self._calls.values()), {}
        for hear in waiting:
            hear(self.cut)

    def _hand_on(self, document: Mapping[str, Any]) -> None:
        number = document.get("id", 0)
        hear = self._calls.get(number) if "next" in document else self._calls.pop(number, None)
        if hear is not None:
            hear(document)

    def _away(self, exc: Exception) -> Gone:
        closed = getattr(exc, "rcvd", None)  # what the other end said as it closed
        return away(self._url, closed.reason if closed is not None and closed.reason else exc)


def context(remote: Remote) -> ssl.SSLContext | None:
    """Return how a coordinator is known by TLS, None where it is asked without."""
    if not remote.url.startswith("https:"):
        return None
    found = ssl.create_default_context()
    if own := remote.certificate or certificate_of(remote.url):
        found.load_verify_locations(cadata=own)
    return found


def headers(remote: Remote) -> dict[str, str]:
    """Return by what a coordinator knows who asks; raises PicoError where the tokens can't be read."""
    token = token_of(remote.url)
    return {"Authorization": f"Bearer {token}"} if token else {}


def _connected(far: Far) -> tuple[ExitStack, Any]:
    """Return what closes a connection, and that."""
    try:
        from websockets.exceptions import InvalidStatus, WebSocketException
        from websockets.sync.client import connect
    except ImportError as exc:
        raise missing_extra(exc) from exc
    url = far.remote.url
    opened = ExitStack()
    try:
        opening = connect(
            f"ws{url.removeprefix('http')}/api/benches/{far.lab}/{far.bench}/link", ssl=context(far.remote), proxy=None,
            additional_headers=headers(far.remote), max_size=wire.LONGEST, open_timeout=OPENING, close_timeout=1.0,
            compression=None,
        )  # fmt: skip
        found = opened.enter_context(opening)
        _greet(found, far)
        return opened, found
    except InvalidStatus as exc:
        raise refused(exc.response.status_code, bytes(exc.response.body or b""), url, far) from exc
    except (OSError, WebSocketException, ValueError) as exc:
        raise opening_trouble(url, exc) from exc


def opening_trouble(url: str, exc: object) -> PicoError:
    """Return what is said where a coordinator can't be reached."""
    if isinstance(exc, ssl.SSLCertVerificationError):
        return untrusted(url, exc.verify_message)
    return away(url, getattr(exc, "strerror", None) or exc)


def _greet(found: Any, far: Far) -> None:
    """Have either side say who it is; raises PicoError for a coordinator that does not let anybody in."""
    from pico.edge.network.trouble import told

    found.send(json.dumps({"hello": {"session": session_in(far.folder), "version": __version__}}))
    document = json.loads(found.recv(timeout=OPENING))
    if "hello" not in document:
        failed = told(document)
        raise failed if isinstance(failed, PicoError) else ValueError("it is no coordinator of PICO")
