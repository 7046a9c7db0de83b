"""Benches, and who has them."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import Query, Request
from fastapi.responses import JSONResponse
from pydantic import Field

from pico.control.leases import TTL, Lease, Turn
from pico.diagnostics import ExitCode, PicoError, error
from pico.server.access.principal import Principal
from pico.server.routes.admitting import books, needs, routed
from pico.server.routes.people import Body
from pico.server.store.books import Books

router = routed()
AT = "/benches/{lab}/{bench}/lease"
PATIENCE = 30.0
"""How long a request may wait for a bench [s]; who wants to wait longer asks again, and keeps their place."""
Session = Annotated[str, Field(max_length=100)]
Number = Annotated[int, Field(ge=0, le=2**53)]


class Take(Body):
    """Ask for a bench, and wait so long for it [s]."""

    session: Session
    wait: float = Field(0.0, ge=0, le=PATIENCE)


class Renew(Body):
    """Go on having a bench."""

    session: Session
    token: Number


class Steal(Body):
    """Take a bench from whoever has it, who is told the reason."""

    session: Session
    reason: str = Field(min_length=1, max_length=500)


@router.get("/health", **needs("public"))
async def health() -> dict[str, str]:
    """Say that the coordinator is there."""
    return {"state": "serving"}


@router.get("/benches", **needs("known"))
async def benches(request: Request) -> list[dict[str, Any]]:
    """List the benches of the labs in which one has a role."""
    me: Principal = request.state.principal
    held = books(request.app)
    names = [name for name in held.leases.enrolled() if me.sees(name.partition("/")[0])]
    relay = getattr(request.app.state, "dispatcher", None)
    return [
        {"bench": name, "lease": _shown(*held.leases.shown(name)),
         "connected": None if relay is None else relay.hub.connected(name) is not None}
        for name in names
    ]  # fmt: skip


@router.get(AT, **needs("viewer"))
async def show(request: Request, lab: str, bench: str) -> dict[str, Any]:
    """Say who has a bench, whether that is who asks (`you`), since when, for how long by the clock here (`had` [s]),
    and who is next."""
    found = _shown(*books(request.app).leases.shown(f"{lab}/{bench}"))
    if found["holder"]:
        found["holder"]["you"] = found["holder"]["who"] == request.state.principal.name
    return found


@router.post(AT, **needs("operator"))
async def take(request: Request, lab: str, bench: str, wanted: Take) -> JSONResponse:
    """Ask for a bench: granted with its token once the edge has fenced for it, or how many are before."""
    held, name = books(request.app), f"{lab}/{bench}"
    asker = request.state.principal.asker(wanted.session)
    told = asyncio.Event()
    end = held.listen(lambda turned, _: told.set() if turned == name else None)
    try:
        turn = await held.turn(held.leases.asked, name, asker)
        until = asyncio.get_running_loop().time() + wanted.wait
        while (token := _has(turn.row, asker.session)) is None:
            told.clear()
            try:
                async with asyncio.timeout_at(until):
                    await told.wait()
            except TimeoutError:
                return JSONResponse({"state": "waiting", **_ahead(turn.row, asker.session)}, 202)
            turn = await held.turn(held.leases.asked, name, asker)
        return JSONResponse({"state": "granted", "token": token, "lasts": TTL})
    finally:
        end()


@router.put(AT, **needs("operator"))
async def renew(request: Request, lab: str, bench: str, wanted: Renew) -> dict[str, Any]:
    """Go on having a bench; 409 for who has it no longer."""
    session = request.state.principal.asker(wanted.session).session
    turn = await _turned(request, books(request.app).leases.renewed, f"{lab}/{bench}", session, wanted.token)
    for said in turn.said:
        if said.session == session and said.what == "lost":
            held = books(request.app)
            why = said.why or await held.look(held.leases.taken_over, f"{lab}/{bench}", wanted.token)
            hint = "`pico lease show` says who has it"
            raise PicoError(error("lost", lost(why, turn.row), hint=hint), ExitCode.LOCKED)
    return {"state": "granted", "token": wanted.token, "lasts": TTL}


@router.delete(AT, **needs("operator"))
async def release(
    request: Request, lab: str, bench: str, session: Annotated[str, Query(max_length=100)],
    token: Annotated[int, Query(ge=0, le=2**53)] = 0,
) -> dict[str, Any]:  # fmt: skip
    """Give a bench back, or up waiting for it."""
    mine = request.state.principal.asker(session).session
    turn = await _turned(request, books(request.app).leases.released, f"{lab}/{bench}", mine, token)
    return {"released": any(deed.deed == "released" for deed in turn.audit)}


@router.post(f"{AT}/steal", **needs("lease:steal"))
async def steal(request: Request, lab: str, bench: str, wanted: Steal) -> JSONResponse:
    """Take a bench from whoever has it, with a reason that they are told."""
    if not wanted.reason.strip():
        raise PicoError(error("usage", "a bench is taken over with a reason", hint="it is told to who had it"))
    asker = request.state.principal.asker(wanted.session)
    turn = await _turned(request, books(request.app).leases.stolen, f"{lab}/{bench}", asker, wanted.reason)
    if turn.row.grant is None or turn.row.grant.holder != asker:
        text = f"the edge of {lab}/{bench} has not been heard of since the coordinator began"
        raise PicoError(error("away", text, hint="a bench is taken over once its edge is there"))
    return JSONResponse({"state": "fencing", "token": turn.row.grant.token, "lasts": TTL}, 202)


async def _turned(request: Request, work: Any, *arguments: Any) -> Turn:
    held: Books = books(request.app)
    turn: Turn = await held.turn(work, *arguments)
    return turn


def lost(why: str, row: Lease) -> str:
    """Return what somebody is told who has a bench no longer."""
    now = f"; {row.grant.holder.who} has it now" if row.grant else ""
    return f"the lease of {row.bench} is lost{f' ({why})' if why else ''}{now}"


def _has(row: Lease, session: str) -> int | None:
    grant = row.grant
    return grant.token if grant and grant.fenced and grant.holder.session == session else None


def _ahead(row: Lease, session: str) -> dict[str, Any]:
    names = [asker.session for asker in row.queue]
    grant = row.grant
    ahead = names.index(session) if session in names else 0
    return {"ahead": ahead, "holder": grant.holder.who if grant else None}


def _shown(row: Lease, now: float, since: float) -> dict[str, Any]:
    grant = row.grant if row.grant and row.grant.expires >= now else None
    holder = grant and {
        "who": grant.holder.who, "session": grant.holder.session, "token": grant.token, "since": since,
        "had": now - since, "left": grant.expires - now, "fenced": grant.fenced, "run": grant.job,
    }  # fmt: skip
    return {"bench": row.bench, "holder": holder, "waiting": [asker.who for asker in row.queue]}
