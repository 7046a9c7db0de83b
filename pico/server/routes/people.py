"""Principals, tokens, the way in, and the audit."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Query, Request
from pydantic import BaseModel, ConfigDict, Field

from pico.diagnostics import PicoError, error
from pico.server.access.principal import Principal, require_name, right, unauthenticated
from pico.server.routes.admitting import books, guessing, needs, routed
from pico.server.store.ordered import broken, read_audit
from pico.server.store.people import Issued

router = routed()
DAYS = 30.0
"""How long a token lasts where nothing else is said [days]."""


class Body(BaseModel):
    """What is sent to a route; nothing else may be in it."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class Login(Body):
    """A code that is exchanged for a token, and what the token is for."""

    code: str = Field(max_length=200)
    label: str = Field("", max_length=200)


class Settled(Body):
    """What a principal may, `role` or `role@lab` each."""

    rights: list[str] = Field(max_length=200)
    disabled: bool = False


class Wanted(Body):
    """A token or a code to be made. `scope`: what of its principal's rights it carries, all without."""

    kind: str = Field("token", pattern="^(token|code)$")
    principal: str | None = Field(None, max_length=64)
    days: float = Field(DAYS, gt=0, le=366)
    label: str = Field("", max_length=200)
    scope: list[str] | None = Field(None, max_length=200)


def _caller(request: Request) -> Principal:
    found: Principal = request.state.principal
    return found


def _made(made: Issued) -> dict[str, Any]:
    return {"id": made.id, "secret": made.secret, "expires_at": made.expires_at}


@router.post("/login", **needs("public"))
async def login(request: Request, wanted: Login) -> dict[str, Any]:
    """Exchange a one-time code for a token."""
    with guessing(request):
        people = books(request.app).people
        made = await books(request.app).do(people.exchanged, wanted.code, wanted.label, DAYS * 86400)
        if made is None:
            raise unauthenticated()
    return _made(made)


@router.get("/whoami", **needs("known"))
async def whoami(request: Request) -> dict[str, Any]:
    """Say whom the token lets in, what it may, and until when."""
    me = _caller(request)
    return {"name": me.name, "rights": sorted(map(str, me.rights)), "token": me.token, "expires_at": me.expires_at}


@router.get("/principals", **needs("admin"))
async def principals(request: Request) -> list[dict[str, Any]]:
    """List people and programs with their rights."""
    return list(books(request.app).people.listed())


@router.put("/principals/{name}", **needs("admin"))
async def settle(request: Request, name: str, wanted: Settled) -> dict[str, Any]:
    """Make a principal, or change what it may."""
    having = [right(text) for text in wanted.rights]
    people = books(request.app).people
    me = _caller(request)
    if name == me.name and (wanted.disabled or not any(r.role == "admin" and r.lab == "*" for r in having)):
        raise PicoError(error("usage", "an admin can't shut themselves out", hint="another admin can"))
    await books(request.app).do(people.settled, name, having, by=me.name, disabled=wanted.disabled)
    return {"name": name, "rights": sorted(map(str, having)), "disabled": wanted.disabled}


@router.get("/tokens", **needs("known"))
async def tokens(request: Request) -> list[dict[str, Any]]:
    """List tokens that last: one's own, an admin's view is of all."""
    me = _caller(request)
    return list(books(request.app).people.tokens(None if me.may("admin", "*") else me.name))


@router.post("/tokens", **needs("known"))
async def issue(request: Request, wanted: Wanted) -> dict[str, Any]:
    """Make a token or a code: of oneself with no more than this token may, of others as an admin."""
    me = _caller(request)
    name = me.name if wanted.principal is None else require_name(wanted.principal, "a principal")
    scope = None if wanted.scope is None else [right(text) for text in wanted.scope]
    if not me.may("admin", "*"):
        if name != me.name:
            me.require("admin", "*")
        scope = list(me.rights if scope is None else scope)
        if beyond := [r for r in scope if not me.may(r.role, r.lab)]:
            me.require(beyond[0].role, beyond[0].lab)
    days = min(wanted.days, 2.0) if wanted.kind == "code" else wanted.days
    people = books(request.app).people
    made = await books(request.app).do(
        people.issued, name, days * 86400, by=me.name, kind=wanted.kind, label=wanted.label, scope=scope,
        parent=me.token,
    )  # fmt: skip
    return _made(made)


@router.delete("/tokens/{token}", **needs("known"))
async def revoke(request: Request, token: str) -> dict[str, Any]:
    """End a token: one's own, or any as an admin."""
    me = _caller(request)
    people = books(request.app).people
    of = None if me.may("admin", "*") else me.name
    if not await books(request.app).do(people.revoked, token, by=me.name, of=of):
        raise PicoError(
            error("unknown-token", f"no token {token[:40]} lasts here", hint="`pico token list` names them")
        )
    return {"id": token}


@router.get("/audit", **needs("admin"))
async def audit(
    request: Request, since: Annotated[int, Query(ge=0, le=2**53)] = 0,
    limit: Annotated[int, Query(ge=1, le=1000)] = 1000,
) -> dict[str, Any]:  # fmt: skip
    """Return entries of the audit, and the first one that is not as it was written."""
    with books(request.app).database.reading() as connection:
        return {"entries": list(read_audit(connection, since, limit)), "broken": broken(connection)}
