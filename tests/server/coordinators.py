"""A coordinator that serves in a thread of this process, and what asks it."""

from __future__ import annotations

import asyncio
import http.client
import json
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import insert
from websockets.sync.client import ClientConnection, connect

from pico.server.access.principal import right
from pico.server.app import create_app
from pico.server.guard.rates import Rate
from pico.server.running import listening, server
from pico.server.store.books import Books, books_in
from pico.server.store.tables import benches

BENCH = "shel/bench1"


@dataclass
class Hand:
    """A clock that a test sets [s]."""

    seconds: float = 1e9

    def __call__(self) -> float:
        return self.seconds


@dataclass
class Served:
    """A coordinator at a port of 127.0.0.1, its books, and the clock that they go by."""

    books: Books
    port: int
    clock: Hand
    app: Any

    def loosen(self) -> None:
        """Let everybody ask as often as they like."""
        self.app.state.failures = self.app.state.requests = Rate(1e9, 1e9)

    def person(self, name: str, *rights: str, lasts: float = 3600.0) -> str:
        """Return a token of a principal who has some rights."""
        self.books.people.settled(name, [right(text) for text in rights], by="test")
        return self.books.people.issued(name, lasts, by="test").secret

    def bench(self, name: str = BENCH, fenced: int | None = 0) -> None:
        """Let there be a bench, whose edge has said what it fenced for unless that is None."""
        with self.books.database.writing() as connection:
            connection.execute(insert(benches).values(bench=name, enrolled_at=0.0))
        if fenced is not None:
            self.books.leases.heard(name, fenced)

    def ask(
        self, method: str, path: str, token: str | None = None, body: Any = None,
        headers: Mapping[str, str] | None = None,
    ) -> tuple[int, Any]:  # fmt: skip
        """Return status and document of an answer; `body`: bytes as they are, all else as JSON."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        sent = {"authorization": f"Bearer {token}"} if token is not None else {}
        data = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
        if data is not None:
            sent["content-type"] = "application/json"
        try:
            link.request(method, path, data, {**sent, **(headers or {})})
            answer = link.getresponse()
            said = answer.read()
            told = answer.getheader("content-type", "").startswith("application/json")
            return answer.status, json.loads(said) if told else said
        finally:
            link.close()

    def chunked(self, method: str, path: str, token: str, data: bytes) -> int:
        """Return the status of an answer to a body whose length was not said."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        pieces = (data[at : at + 65536] for at in range(0, len(data), 65536))
        try:
            sent = {"authorization": f"Bearer {token}", "content-type": "application/json"}
            link.request(method, path, pieces, sent, encode_chunked=True)
            return link.getresponse().status
        finally:
            link.close()

    def watch(self, path: str, token: str | None = None, **options: Any) -> ClientConnection:
        """Open a socket."""
        sent = {"authorization": f"Bearer {token}"} if token is not None else {}
        sent |= options.pop("additional_headers", {})
        at = f"ws://127.0.0.1:{self.port}{path}"
        options.setdefault("max_queue", None)  # one who reads no more must not keep the socket from closing
        return connect(at, additional_headers=sent, open_timeout=30, close_timeout=30, proxy=None, **options)


@contextmanager
def served(folder: Path, **options: Any) -> Iterator[Served]:
    """Serve the books in a folder."""
    clock = Hand()
    books = books_in(folder, clock)
    listener = listening("127.0.0.1", 0)
    app = create_app(books, **options)
    serving = server(app)
    thread = threading.Thread(target=lambda: asyncio.run(serving.serve(sockets=[listener])))
    thread.start()
    try:
        while not serving.started and thread.is_alive():
            thread.join(0.01)
        yield Served(books, listener.getsockname()[1], clock, app)
    finally:
        serving.should_exit = True
        thread.join()
        listener.close()
        books.close()
