"""How a browser gets in: a token, or a one-time code, is exchanged for a cookie that no script reads."""

from __future__ import annotations

from typing import Any

from fastapi import Request, Response
from pydantic import Field

from pico.diagnostics import PicoError, error
from pico.server.access.principal import Principal, unauthenticated
from pico.server.routes.admitting import books, cookie_name, guessing, needs, routed, session_of
from pico.server.routes.people import DAYS, Body
from pico.server.store.people import Issued, People

router = routed()
LABEL = "a browser"


class Shown(Body):
    """A token, or a code that is good for one; one of both."""

    secret: str | None = Field(None, max_length=200)
    code: str | None = Field(None, max_length=200)


@router.post("/session", **needs("public"))
async def enter(request: Request, response: Response, shown: Shown) -> dict[str, Any]:
    """Let a browser in until its session ends, at the latest with the token that it was given for."""
    if (shown.secret is None) == (shown.code is None):
        raise PicoError(error("usage", "a session is given for one of `secret` (a token) and `code`"))
    held = books(request.app)
    with guessing(request):
        made = await held.do(_opened, held.people, shown)
        found = held.people.seated(made.secret) if made is not None else None
        if made is None or found is None:
            raise unauthenticated()
    response.set_cookie(
        cookie_name(request), made.secret, expires=None, path="/", httponly=True, samesite="strict",
        secure=request.url.scheme == "https",
    )  # fmt: skip
    return _whom(found) | {"expires_at": made.expires_at}


def _opened(people: People, shown: Shown) -> Issued | None:
    secret = shown.secret
    if shown.code is not None:
        exchanged = people.exchanged(shown.code, LABEL, DAYS * 86400)
        secret = exchanged.secret if exchanged is not None else None
    return people.opened(secret) if secret else None


@router.get("/session", **needs("known"))
async def who(request: Request) -> dict[str, Any]:
    """Say whom the session (or the token) lets in, and what it may."""
    me: Principal = request.state.principal
    return _whom(me) | {"expires_at": me.expires_at}


@router.delete("/session", **needs("known"))
async def leave(request: Request, response: Response) -> dict[str, bool]:
    """End the session of this browser."""
    held, session = books(request.app), session_of(request)
    ended = bool(session) and await held.do(held.people.closed, session)
    response.delete_cookie(cookie_name(request), path="/")
    return {"ended": ended}


def _whom(me: Principal) -> dict[str, Any]:
    return {"name": me.name, "rights": sorted(map(str, me.rights)), "token": me.token}
