"""An edge that is enrolled with a coordinator, in a thread of this process, and a client that speaks to it."""

from __future__ import annotations

import asyncio
import itertools
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from coordinators import BENCH, Served
from websockets.sync.client import ClientConnection

from pico.diagnostics import PicoError
from pico.edge.link import wire
from pico.edge.link.server import edge_of
from pico.edge.local import LocalEdge
from pico.edge.network.enrolment import enrol, read_enrolment
from pico.edge.network.uplink import Uplink
from pico.model.record import as_json
from pico.places.bench import BenchPlace
from pico.server.store.edges import Edges


@dataclass
class Connected:
    """An edge and its line, in the loop of a thread."""

    edge: LocalEdge
    uplink: Uplink
    loop: asyncio.AbstractEventLoop

    def cut(self) -> None:
        """Cut the line to the coordinator; it dials again."""
        link = self.uplink._link
        if link is not None:
            self.loop.call_soon_threadsafe(link.transport.abort)


@contextmanager
def connected(served: Served, root: Path, bench: str = BENCH) -> Iterator[Connected]:
    """Enrol the bench of the lab in `root`, unless it is, and connect its edge meanwhile."""
    if read_enrolment(BenchPlace(root, "sim")) is None:
        code, _ = Edges(served.books.database).invited(bench, "test")
        enrol(BenchPlace(root, "sim"), f"http://127.0.0.1:{served.port}", code)
    ready, made = threading.Event(), list[Connected]()

    async def live() -> None:
        edge, enrolment = edge_of(BenchPlace(root, "sim"), "kinematic"), read_enrolment(BenchPlace(root, "sim"))
        assert enrolment is not None
        uplink, loop = Uplink(edge, enrolment), asyncio.get_running_loop()
        made.append(Connected(edge, uplink, loop))
        task = asyncio.create_task(uplink.run())
        stop.append(lambda: loop.call_soon_threadsafe(task.cancel))
        ready.set()
        with suppress(asyncio.CancelledError):
            await task
        await edge.close()

    stop: list[Any] = []
    thread = threading.Thread(target=lambda: asyncio.run(live()))
    thread.start()
    try:
        assert ready.wait(30)
        yield made[0]
    finally:
        stop[0]()
        thread.join()


@dataclass
class Client:
    """A client's socket; arguments and values are model types."""

    socket: ClientConnection
    numbers: Iterator[int] = field(default_factory=lambda: itertools.count(1))
    heard: dict[int, list[dict[str, Any]]] = field(default_factory=dict)

    def begin(self, call: str, *arguments: Any) -> int:
        """Make a call, and return its number."""
        number = next(self.numbers)
        self.socket.send(json.dumps({"id": number, "call": call, "with": [as_json(a) for a in arguments]}))
        return number

    def answer(self, number: int) -> dict[str, Any]:
        """Return the next answer to a call."""
        while not self.heard.get(number):
            said = json.loads(self.socket.recv(timeout=60))
            self.heard.setdefault(said.pop("id"), []).append(said)
        return self.heard[number].pop(0)

    def ask(self, call: str, *arguments: Any) -> Any:
        """Return what a call gives; raises PicoError."""
        return wire.read_answer(call, json.dumps(self.answer(self.begin(call, *arguments))).encode())[1]

    def close(self, number: int) -> None:
        """Let go of what a call took, and wait until that is so."""
        self.socket.send(json.dumps({"id": number, "close": True}))
        while "closed" not in self.answer(number):
            pass

    def events(self, run: str) -> list[dict[str, Any]]:
        """Return all that happens in a run."""
        number, found = self.begin("events", run, 0), list[dict[str, Any]]()
        while "next" in (said := self.answer(number)):
            found.append(said["next"])
        if "error" in said:
            wire.read_answer("events", json.dumps(said).encode())
        return found


@contextmanager
def client(served: Served, token: str, session: str = "s1", bench: str = BENCH) -> Iterator[Client]:
    """Connect a client."""
    with served.watch(f"/api/benches/{bench}/link", token) as socket:
        socket.send(json.dumps({"hello": {"session": session, "version": "test"}}))
        assert json.loads(socket.recv(timeout=30))["hello"]["bench"] == bench
        yield Client(socket)


def refusal(client: Client, call: str, *arguments: Any) -> PicoError:
    """Return how a call is refused."""
    try:
        found = client.ask(call, *arguments)
    except PicoError as exc:
        return exc
    raise AssertionError(f"{call} gave {found!r}")
