"""The way in of edges: they are enrolled by a code, and then say by their key who they are."""

from __future__ import annotations

import asyncio
import secrets
from contextlib import suppress
from typing import Annotated, Any

from fastapi import Request, WebSocket
from pydantic import Field
from starlette.websockets import WebSocketDisconnect

from pico.diagnostics import PicoError, error
from pico.edge.network import messages
from pico.server.access.principal import Principal
from pico.server.guard.door import mark_known
from pico.server.relay.dispatch import Dispatcher
from pico.server.relay.hub import EdgeLine, Gone
from pico.server.relay.polling import Polled, record_from_json
from pico.server.routes.admitting import books, guessing, needs, refusal, routed
from pico.server.routes.people import Body
from pico.server.store.edges import Edges

router = routed()
STRANGER, BROKEN = 4401, 4400
"""With which the socket of one is closed that has not the key, and of one that says what nobody reads."""
GREETING = 10.0
"""Seconds in which an edge says who it is."""
Name = Annotated[str, Field(max_length=130)]


class Enrol(Body):
    """A code that was given for a bench, and the key by which its edge is known from then on."""

    code: str = Field(max_length=200)
    key: str = Field(pattern="^[0-9a-f]{64}$")


class Invite(Body):
    """The bench that is to be enrolled, `lab/name`."""

    bench: str = Field(max_length=130)


@router.post("/edge/enrol", **needs("public"))
async def enrol(request: Request, wanted: Enrol) -> dict[str, str]:
    """Exchange a code for a bench's name."""
    held = books(request.app)
    with guessing(request):
        return {"bench": await held.do(Edges(held.database).enrolled, wanted.code, wanted.key)}


@router.post("/enrolments", **needs("admin"))
async def invite(request: Request, wanted: Invite) -> dict[str, Any]:
    """Make a code with which the edge of a bench is enrolled once."""
    me: Principal = request.state.principal
    held = books(request.app)
    code, over = await held.do(Edges(held.database).invited, wanted.bench, me.name)
    return {"code": code, "expires_at": over}


@router.delete("/enrolments/{lab}/{bench}", **needs("admin"))
async def revoke(request: Request, lab: str, bench: str) -> dict[str, bool]:
    """Let the edge of a bench in no more."""
    me: Principal = request.state.principal
    held, name = books(request.app), f"{lab}/{bench}"
    ended = await held.do(Edges(held.database).revoked, name, me.name)
    dispatcher: Dispatcher = request.app.state.dispatcher
    if (line := dispatcher.hub.connected(name)) is not None:
        line.end()
    return {"revoked": ended}


@router.websocket("/edge/link")
async def link(socket: WebSocket) -> None:
    """Serve the edge that has the key of a bench, as long as it is connected."""
    try:
        bench, nonce, key = await _known(socket)
    except PicoError as exc:
        await socket.send_denial_response(refusal(exc))
        return
    await socket.accept()
    try:
        async with asyncio.timeout(GREETING):
            line, records = await _greeted(socket, bench, nonce, key)
            mark_known(socket.scope)
    except (KeyError, TypeError, ValueError, TimeoutError, PicoError, WebSocketDisconnect):
        with suppress(RuntimeError, WebSocketDisconnect):  # it is gone already
            await socket.close(STRANGER)
        return
    dispatcher: Dispatcher = socket.app.state.dispatcher
    try:
        await books(socket.app).do(dispatcher.rows.reconciled, line.bench, line.fenced, records)
    except OverflowError:
        await socket.close(BROKEN)
        return
    polled = Polled(books(socket.app), dispatcher.rows, line)
    asking, idle = asyncio.Queue[dict[str, Any]](), asyncio.Event()
    polling = asyncio.create_task(_polled(polled, asking, idle, line, dispatcher))
    tasks = [polling, asyncio.create_task(_ended(socket, line))]
    try:
        while not line.over.is_set():
            said = messages.read(await socket.receive_text())
            if "poll" in said:
                idle.clear()
                asking.put_nowait(said["poll"])
            else:
                await idle.wait()  # what was said before is known before
                line.heard(said)
    except (WebSocketDisconnect, RuntimeError):
        pass
    except (KeyError, TypeError, ValueError, AttributeError, PicoError):
        with suppress(RuntimeError, WebSocketDisconnect):
            await socket.close(BROKEN)
    finally:
        dispatcher.hub.left(line)
        for task in tasks:
            task.cancel()


async def _known(socket: WebSocket) -> tuple[str, str, bytes]:
    """Return the bench that a socket says it is the edge of, its nonce, and the key that it seems to have; raises
    PicoError (status 401)."""
    with guessing(socket):
        words = socket.headers.get("authorization", "").split()
        if len(words) == 4 and words[0] == messages.SCHEME:
            _, bench, nonce, shown = words
            held = books(socket.app)
            key = await held.do(Edges(held.database).key, bench)
            if key and secrets.compare_digest(shown, messages.proof(key, "dials", bench, nonce, "")):
                return bench, nonce, key
        raise PicoError(error("unauthenticated", "no edge that is enrolled here", hint="`pico edge enrol`"))


async def _greeted(socket: WebSocket, bench: str, theirs: str, key: bytes) -> tuple[EdgeLine, list[Any]]:
    """Show each other the key of the bench, over what both have just drawn; then hear what its edge remembers."""
    mine, held = secrets.token_hex(16), books(socket.app)
    dispatcher: Dispatcher = socket.app.state.dispatcher
    opened = await held.do(dispatcher.rows.open, bench)
    proof = messages.proof(key, "coordinator", bench, theirs, mine)
    await socket.send_text(messages.text({"nonce": mine, "proof": proof, "open": list(opened)}))
    answer = messages.read(await socket.receive_text())
    if not secrets.compare_digest(str(answer["proof"]), messages.proof(key, "edge", bench, theirs, mine)):
        raise ValueError("no key")
    hello = answer["hello"]

    async def send(document: Any) -> None:
        await socket.send_text(messages.text(document))

    return EdgeLine(bench, hello, send), [record_from_json(one) for one in hello["records"]]


async def _polled(
    polled: Polled, asking: asyncio.Queue[dict[str, Any]], idle: asyncio.Event, line: EdgeLine, dispatcher: Dispatcher
) -> None:
    """Answer questions one after the other; from the first one on the edge is there for others."""
    joined = False
    try:
        while True:
            poll = await asking.get()
            await line.told(await polled.answer(poll))
            if not joined:
                joined = True
                dispatcher.hub.joined(line)
                await dispatcher.resumed(line.bench)
            if asking.empty():
                idle.set()
    except (Gone, KeyError, TypeError, ValueError, OverflowError):
        pass
    finally:
        line.end()
        idle.set()


async def _ended(socket: WebSocket, line: EdgeLine) -> None:
    """Close the socket of an edge that another one took the place of, or that was let in no more."""
    await line.over.wait()
    with suppress(RuntimeError):
        await socket.close()
