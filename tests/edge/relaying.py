"""A coordinator for tests, in a process of its own, of one simulated bench: it speaks as the real one to clients, and
lets everybody in who says TOKEN."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pico.edge.link.server import Server, edge_of
from pico.edge.network.remotes import Remote, Remotes, keep
from pico.edge.protocol import Lease

TOKEN = "of-a-test"


class Client:
    """What one client has taken, by the number of the call that took it."""

    def __init__(self, server: Server, socket: Any) -> None:
        self.server, self.socket = server, socket
        self.leases: dict[int, list[Lease]] = {}
        self.runs: dict[int, list[str]] = {}
        self.answering: dict[int, asyncio.Task[None]] = {}

    async def serve(self) -> None:
        await self.socket.recv()
        await self.socket.send(json.dumps({"hello": {}}))
        try:
            async for text in self.socket:
                said = json.loads(text)
                if said.get("close"):
                    await self.let_go(said["id"])
                else:
                    self.answering[said["id"]] = asyncio.create_task(self.answer(said))
        finally:
            for number in list(self.answering):
                await self.let_go(number)

    async def answer(self, said: dict[str, Any]) -> None:
        number = said.pop("id")
        leases, runs = self.leases.setdefault(number, []), self.runs.setdefault(number, [])
        async for document in self.server._answers(json.dumps(said).encode(), leases, runs):
            await self.socket.send(json.dumps({"id": number, **document}))

    async def let_go(self, number: int) -> None:
        if (task := self.answering.pop(number, None)) is not None:
            task.cancel()
            await asyncio.wait([task])
        for lease in self.leases.pop(number, []):
            await self.server._edge.release(lease)
        for run in self.runs.pop(number, []):
            await self.server._edge.alone.gone(run)


async def _serve(root: Path, fidelity: str, ready: int) -> None:
    from websockets.asyncio.server import serve

    server, over = Server(edge_of(root, "sim", fidelity)), asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, over.set)

    def known(connection: Any, request: Any) -> Any:
        if request.headers.get("Authorization") != f"Bearer {TOKEN}":
            return connection.respond(401, json.dumps({"detail": "no such token"}))
        return None if request.path == "/api/benches/shel/bench1/link" else connection.respond(404, "")

    async def client(socket: Any) -> None:
        await Client(server, socket).serve()

    async with serve(client, "127.0.0.1", 0, process_request=known, max_size=None) as serving:
        os.write(ready, b"%d\n" % next(iter(serving.sockets)).getsockname()[1])
        await over.wait()
    await server._edge.close()


@contextmanager
def relayed(root: Path, fidelity: str = "kinematic") -> Iterator[str]:
    """Serve the simulated bench of the lab in `root` as `shel/bench1` of a coordinator; yields its address."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(reading)
            os.setsid()
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            asyncio.run(_serve(root, fidelity, writing))
            code = 0
        except BaseException as exc:
            print(f"the relay ended: {exc!r}", file=sys.stderr, flush=True)
        finally:
            os._exit(code)
    os.close(writing)
    try:
        yield f"http://127.0.0.1:{int(os.read(reading, 16))}"
    finally:
        os.close(reading)
        os.kill(child, signal.SIGTERM)
        os.waitpid(child, 0)


def point(lab: Path, url: str, bench: str = "shel/bench1") -> None:
    """Let a checkout know a coordinator, and its bench as the one that is meant."""
    keep(lab, Remotes({"lab": Remote(url)}, f"lab/{bench}"))
