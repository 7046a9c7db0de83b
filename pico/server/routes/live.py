"""A bench as pages draw it: its scene, and a socket that says what changes."""

from __future__ import annotations

import json
from typing import Any

from fastapi import Request, WebSocket

from pico.diagnostics import PicoError, error
from pico.server.live.watcher import Watcher
from pico.server.live.watching import Watched, Watching
from pico.server.routes.admitting import Admitted, admit, books, needs, refusal, routed
from pico.server.routes.lasting import lasting, left
from pico.version import __version__

router = routed()


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
    hello = {**watched.where(), "seq": watched.seq, "bench": watched.bench, "version": __version__}
    watcher.tell(json.dumps({"hello": hello}, separators=(",", ":")))
    if watched.shown is not None:
        watcher.show(watched.shown.whole(), watched.shown.whole)
    watched.watchers.add(watcher)
    try:
        await lasting(socket, admitted, left(socket), _told(socket, watcher))
    finally:
        watched.watchers.discard(watcher)


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
