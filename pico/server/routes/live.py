"""A bench as pages draw it: its scene, and a socket that says what changes."""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from typing import Any

from fastapi import Request, WebSocket
from starlette.websockets import WebSocketDisconnect

import pico
from pico.diagnostics import PicoError, error
from pico.server.guard.saying import failure
from pico.server.live.watcher import Watcher
from pico.server.live.watching import Watched, Watching
from pico.server.routes.admitting import FRESH, Admitted, admit, books, needs, refusal, routed

router = routed()
OVER, BEHIND = 4401, 4408
"""With which a socket is closed whose token is over, and one that does not take what it is told."""


@router.get("/benches/{lab}/{bench}/scene", **needs("viewer"))
async def scene(request: Request, lab: str, bench: str) -> dict[str, Any]:
    """Return a bench as it is drawn (`pico.scene/v1`): table, arms as chains of links, components with their shapes and
    how they stand, light. Lengths in mm, angles in deg, joints in rad."""
    books(request.app).leases.shown(f"{lab}/{bench}")  # says where there is no such bench
    watching: Watching = request.app.state.watching
    return await watching.scene(f"{lab}/{bench}")


@router.websocket("/benches/{lab}/{bench}/live")
async def live(socket: WebSocket, lab: str, bench: str) -> None:
    """Tell what changes at a bench: first `{"hello": {"epoch", "rev", "seq"}}`, then events as text, in order
    (`{"seq", "epoch", "rev", "kind", "data"}`), and frames as bytes (`pico.drawing.scene.frames`), of which the latest
    alone counts. Where the `epoch` is another one than that of the scene that is drawn, or `seq` leaves one out, the
    scene is to be asked for again."""
    admitted = await admit(socket, "viewer", lab)
    if admitted is None:
        return
    name, watching = f"{lab}/{bench}", socket.app.state.watching
    try:
        books(socket.app).leases.shown(name)
    except PicoError as exc:  # there is no such bench
        await socket.send_denial_response(refusal(exc))
        return
    await socket.accept()
    async with watching.bench(name) as watched:
        await _watch(socket, admitted, watched)


async def _watch(socket: WebSocket, admitted: Admitted, watched: Watched) -> None:
    watcher = Watcher()
    hello = {**watched.where(), "seq": watched.seq, "bench": watched.bench, "version": pico.__version__}
    watcher.tell(json.dumps({"hello": hello}, separators=(",", ":")))
    if watched.shown is not None:
        watcher.show(watched.shown.whole(), watched.shown.whole)
    watched.watchers.add(watcher)
    tasks = [asyncio.create_task(_left(socket)), asyncio.create_task(_told(socket, watcher)),
             asyncio.create_task(_known(admitted))]  # fmt: skip
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    except PicoError as exc:
        with suppress(RuntimeError, WebSocketDisconnect):
            await socket.send_text(json.dumps(failure(exc)))
            await socket.close(BEHIND if watcher.lost else OVER)
    except (WebSocketDisconnect, RuntimeError):
        pass
    finally:
        watched.watchers.discard(watcher)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _left(socket: WebSocket) -> None:
    """Wait until a socket is closed; what it says meanwhile counts for nothing."""
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass


async def _known(admitted: Admitted) -> None:
    """Raise PicoError once the token is over, or may watch no more."""
    while True:
        await asyncio.sleep(FRESH)
        admitted.principal()


async def _told(socket: WebSocket, watcher: Watcher) -> None:
    """Send what waits; raises PicoError where too much does."""
    while True:
        await watcher.news.wait()
        for said in watcher.taken():
            if isinstance(said, bytes):
                await socket.send_bytes(said)
            else:
                await socket.send_text(said)
        if watcher.lost:
            raise PicoError(error("behind", "events are not taken as fast as they come", hint="open the socket anew"))
