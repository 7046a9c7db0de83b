"""The socket of a client: many calls at a time to one bench, and what they take is given back when it ends."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect

from pico.diagnostics import PicoError, error
from pico.edge.link import wire
from pico.edge.network import messages
from pico.server.guard.gatekeeper import BODY, LONG_BODY
from pico.server.relay.dispatch import Call, Dispatcher
from pico.server.relay.hub import Gone
from pico.server.routes.admitting import Admitted, admit, books, refusal, routed
from pico.server.routes.lasting import lasting
from pico.version import __version__

router = routed()
MANY = 64
"""Calls of one socket at a time."""
LONG = ("start", "open", "adopt", "world.put")
"""Calls that carry a plan or a lab, and may be longer than others."""


@router.websocket("/benches/{lab}/{bench}/link")
async def link(socket: WebSocket, lab: str, bench: str) -> None:
    """Hand calls on to the edge of a bench, and its answers back."""
    admitted = await admit(socket, "any", lab)
    if admitted is None:
        return
    try:
        books(socket.app).leases.shown(f"{lab}/{bench}")
    except PicoError as exc:  # there is no such bench
        await socket.send_denial_response(refusal(exc))
        return
    await socket.accept()
    client = _Client(socket, admitted, f"{lab}/{bench}")
    try:
        await lasting(socket, admitted, client.serve())
    finally:
        await asyncio.shield(client.gone())


class _Client:
    def __init__(self, socket: WebSocket, admitted: Admitted, bench: str) -> None:
        self._socket, self._admitted, self._bench = socket, admitted, bench
        self._dispatcher: Dispatcher = socket.app.state.dispatcher
        self._session = ""
        self._calls: dict[int, tuple[asyncio.Task[None], Call]] = {}
        self._closing: set[asyncio.Task[None]] = set()

    async def serve(self) -> None:
        """Answer until the socket ends; raises PicoError for what is no message."""
        while True:
            said = messages.read(await self._received())
            who = self._admitted.principal()
            if "hello" in said:
                hello = said["hello"] if isinstance(said["hello"], dict) else {}
                self._session = str(hello.get("session", ""))
                who.asker(self._session)
                await self._send({"hello": {"bench": self._bench, "who": who.name, "version": __version__}})
                continue
            number = said.get("id")
            if not isinstance(number, int) or not self._session:
                raise PicoError(
                    error("link", "say `hello` with a session first, then calls with an `id`, a number each")
                )
            if said.get("close"):
                self._close(number)
            else:
                await self._called(number, said)

    async def _received(self) -> str:
        message = await self._socket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", 1000))
        text = message.get("text")
        if text is None:
            raise PicoError(error("link", "a message is text: a JSON object"))
        if len(text) > LONG_BODY:
            raise PicoError(error("link", f"a message has {LONG_BODY} bytes at most"))
        return str(text)

    async def _called(self, number: int, said: dict[str, Any]) -> None:
        try:
            if number in self._calls or len(self._calls) >= MANY:
                raise PicoError(error("link", f"a socket has {MANY} calls at a time at most, each with its own `id`"))
            name, arguments = messages.read_call(said)
            if name not in LONG and len(messages.text(said)) > BODY:
                raise PicoError(error("link", f"a message has {BODY} bytes at most"))
            who = self._admitted.principal()
            call = self._dispatcher.call(who, self._session, self._bench, name, arguments)
        except PicoError as exc:
            await self._send({"id": number, **wire.failure(exc)})
            return
        self._calls[number] = (asyncio.create_task(self._answer(number, call)), call)

    async def _answer(self, number: int, call: Call) -> None:
        try:
            async for answer in self._dispatcher.answers(call):
                await self._send({"id": number, **answer})
        except (WebSocketDisconnect, RuntimeError, Gone):
            return
        if call.held is None and call.name != "hold":
            self._calls.pop(number, None)

    async def _send(self, document: dict[str, Any]) -> None:
        await self._socket.send_text(messages.text(document))

    def _close(self, number: int) -> None:
        task, call = self._calls.pop(number, (None, None))
        if task is not None and call is not None:
            closing = asyncio.create_task(self._closed(number, task, call))
            self._closing.add(closing)
            closing.add_done_callback(self._closing.discard)

    async def _closed(self, number: int, task: asyncio.Task[None], call: Call) -> None:
        task.cancel()
        await asyncio.wait([task])
        await self._dispatcher.close(call)
        with suppress(WebSocketDisconnect, RuntimeError):
            await self._send({"id": number, "closed": True})

    async def gone(self) -> None:
        """Let go of all that calls took or follow."""
        for number in list(self._calls):
            self._close(number)
        if self._closing:
            await asyncio.wait(self._closing)
