"""How a socket lasts: until who opened it leaves, until its token is over, or until what goes on over it ends."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Coroutine
from contextlib import suppress
from typing import Any

from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect

from pico.diagnostics import PicoError
from pico.server.guard.saying import failure
from pico.server.routes.admitting import FRESH, Admitted

CODES = {"unauthenticated": 4401, "behind": 4408}
"""With which a socket is closed whose token is over, and one that does not take what it is told."""
BROKEN = 4400
"""With which one is closed that says what nobody reads."""


async def lasting(socket: WebSocket, admitted: Admitted, *work: Coroutine[Any, Any, None]) -> None:
    """Do what goes on over a socket until the first of it ends, or the token is over; whoever is there hears what went
    wrong."""
    tasks = [asyncio.create_task(one) for one in (*work, _known(admitted))]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    except PicoError as exc:
        with suppress(RuntimeError, WebSocketDisconnect):
            await socket.send_text(json.dumps(failure(exc)))
            await socket.close(CODES.get(exc.diagnostics[0].code, BROKEN))
    except (WebSocketDisconnect, RuntimeError, KeyError):  # it is gone, or said what is no text
        pass
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def left(socket: WebSocket) -> None:
    """Wait until a socket is closed; what it says meanwhile counts for nothing."""
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass


async def _known(admitted: Admitted) -> None:
    """Raise PicoError once the token is over, or lets do no more, also where nothing is said."""
    while True:
        await asyncio.sleep(FRESH)
        admitted.principal()
