"""The calls of an edge as requests, one route each, for who has no socket. A run that is started goes on by itself."""

from __future__ import annotations

import json
import secrets
from collections.abc import AsyncIterator
from typing import Any

from fastapi import Request
from fastapi.responses import JSONResponse, Response, StreamingResponse
from pydantic import Field

from pico.edge.link import wire
from pico.edge.network.roles import ROLES
from pico.server.access.principal import Principal
from pico.server.guard.saying import STATUS
from pico.server.relay.dispatch import Call, Dispatcher
from pico.server.routes.admitting import books, needs, routed, while_known
from pico.server.routes.people import Body

router = routed()
AT = "/benches/{lab}/{bench}/calls"
LIVING = frozenset({"acquire", "open", "hold", "live"})
"""Calls of which what they took is given back with the socket they came over, and one that never ends: no routes."""


class Asked(Body):
    """The arguments of a call, and the session in whose name it is made: one of its own where none is said."""

    arguments: list[Any] = Field(default_factory=list, alias="with", max_length=8)
    session: str = Field("", max_length=100)


def _route(name: str) -> None:
    async def called(request: Request, lab: str, bench: str, asked: Asked) -> Response:
        me: Principal = request.state.principal
        dispatcher: Dispatcher = request.app.state.dispatcher
        books(request.app).leases.shown(f"{lab}/{bench}")  # says where there is no such bench
        session = asked.session or f"rest-{secrets.token_hex(8)}"
        call = dispatcher.call(me, session, f"{lab}/{bench}", name, asked.arguments)
        if name in wire.STREAMS:
            return StreamingResponse(
                while_known(request, me, _lines(dispatcher, call)), media_type="application/x-ndjson"
            )
        try:
            async for answer in dispatcher.answers(call):
                return JSONResponse(answer, _status(answer))
        finally:
            await dispatcher.close(call)
        raise AssertionError("a call has an answer")

    said = f"Call `{name}` of the bench's edge."
    role = ROLES[name] or "any"
    router.add_api_route(
        f"{AT}/{name}", called, methods=["POST"], name=name, description=said, response_model=None, **needs(role)
    )


async def _lines(dispatcher: Dispatcher, call: Call) -> AsyncIterator[bytes]:
    try:
        async for answer in dispatcher.answers(call):
            yield json.dumps(answer, separators=(",", ":")).encode() + b"\n"
    finally:
        await dispatcher.close(call)


def _status(answer: Any) -> int:
    if "error" not in answer:
        return 200
    code = answer["error"][0]["code"] if answer["error"] else ""
    if answer["exit"] == 5:
        return 409
    return 403 if answer["exit"] == 7 else STATUS.get(code, 400) if code != "internal" else 502


for one in ROLES:
    if one not in LIVING:
        _route(one)
