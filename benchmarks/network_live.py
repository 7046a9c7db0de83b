"""A bench that moves all the time, told 30 times a second by an edge in a process of its own, and those who watch it;
and what the same machine needs for an echo and for a flush of its disk just then."""

from __future__ import annotations

import asyncio
import json
import math
import os
import time
from pathlib import Path
from typing import Any

from network_bench import dialled

from pico.places.bench import BenchPlace

HERTZ, MOVES = 30.0, 12
"""How often, and how many components move each time beside the arm."""


def telling(port: int, bench: str, key: str, root: Path) -> None:
    """Be the edge of a bench on which an arm and MOVES components move, for ever."""
    asyncio.run(_telling(port, bench, key, root))


async def _telling(port: int, bench: str, key: str, root: Path) -> None:
    from pico.drawing.scene.scene import numbered, scene
    from pico.edge.link.server import edge_of

    edge = edge_of(BenchPlace(root, "sim"), "kinematic")
    moment = await edge.sight.moment()
    whole = scene(edge.setup, moment, numbered(edge.setup, moment)) | {"epoch": 1, "rev": 0}
    async with dialled(port, bench, key) as link:
        asking = asyncio.create_task(_ask(link))
        tasks: dict[str, asyncio.Task[None]] = {}
        async for data in link:
            said = json.loads(data)
            if said.get("call") == "live":
                tasks[said["id"]] = asyncio.create_task(_moving(link, said["id"], whole))
            elif said.get("close"):
                tasks.pop(said["id"]).cancel()
                await link.send(json.dumps({"id": said["id"], "closed": True}))
        asking.cancel()


async def _ask(link: Any) -> None:
    while True:
        poll = {"asked": 1, "fenced": 0, "taken": 0, "busy": False, "moving": None}
        await link.send(json.dumps({"poll": poll}))
        await asyncio.sleep(1.0)


async def _moving(link: Any, number: str, whole: dict[str, Any]) -> None:
    await link.send(json.dumps({"id": number, "next": {"scene": whole}}))
    loop, parts = asyncio.get_running_loop(), [part["index"] for part in whole["components"]]
    began = loop.time()
    for tick in range(1 << 30):
        await asyncio.sleep(max(0.0, began + tick / HERTZ - loop.time()))
        joints = [round(math.sin(tick / 20 + joint), 6) for joint in range(7)]
        bodies = [[parts[n % len(parts)], round(100 + math.sin(tick / 30) * n, 4), 220.5, 0.0, 1.0, 0.0, 0.0, 0.0]
                  for n in range(MOVES)]  # fmt: skip
        moved = {"time": tick / HERTZ, "arms": [[0, joints, 42.0]], "bodies": bodies}
        await link.send(json.dumps({"id": number, "next": {"moved": moved}}, separators=(",", ":")))


async def watching(port: int, bench: str, token: str, count: int, seconds: float) -> tuple[float, float]:
    """Return how many frames a second so many watchers are sent: the one who sees fewest, and all together."""
    from websockets.asyncio.client import connect

    async def watch() -> int:
        seen = 0
        async with connect(
            f"ws://127.0.0.1:{port}/api/benches/{bench}/live", proxy=None, compression=None,
            additional_headers={"Authorization": f"Bearer {token}"}, max_size=None,
        ) as socket:  # fmt: skip
            while not isinstance(await socket.recv(), bytes):
                pass
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                seen += isinstance(await socket.recv(), bytes)
        return seen

    seen = await asyncio.gather(*(watch() for _ in range(count)))
    return min(seen) / seconds, sum(seen) / seconds


def echoing(port: int) -> None:
    """Answer each message of a socket with the same one, for ever."""

    async def serve() -> None:
        from websockets.asyncio.server import serve as listen

        async def echo(socket: Any) -> None:
            async for said in socket:
                await socket.send(said)

        async with listen(echo, "127.0.0.1", port, compression=None) as server:
            await server.serve_forever()

    asyncio.run(serve())


async def echoed(port: int, count: int) -> list[float]:
    """Return how long each of so many echoes took [ms]."""
    from websockets.asyncio.client import connect

    found = []
    async with connect(f"ws://127.0.0.1:{port}", proxy=None, compression=None) as socket:
        for _ in range(count):
            began = time.perf_counter()
            await socket.send('{"id":1,"call":"unended","with":[]}')
            await socket.recv()
            found.append(1000 * (time.perf_counter() - began))
    return found


def flushed(folder: Path, count: int) -> list[float]:
    """Return how long each of so many small writes took until it was on the disk [ms]."""
    found = []
    with (folder / "flushed").open("ab", buffering=0) as file:
        for _ in range(count):
            began = time.perf_counter()
            file.write(b"x" * 400)
            os.fdatasync(file.fileno())
            found.append(1000 * (time.perf_counter() - began))
    return found
