"""What a lab keeps at the coordinator: its repository, as git asks for it, edits without a checkout, and large data."""

from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Annotated, Any

from fastapi import Query, Request
from fastapi.responses import FileResponse, Response, StreamingResponse
from pydantic import Field
from starlette.types import Receive, Scope, Send

from pico.content.store import Store
from pico.diagnostics import PicoError, error
from pico.server.access.principal import Principal
from pico.server.git.edits import committed
from pico.server.git.hosting import Answer, answered, repository
from pico.server.routes.admitting import books, needs, routed
from pico.server.routes.people import Body

router = routed()
Service = Annotated[str, Query(pattern="^git-(upload|receive)-pack$")]


class Edit(Body):
    """Files to be committed on top of a revision, by path; null takes one away."""

    base: str = Field(max_length=200, pattern="^[A-Za-z0-9][A-Za-z0-9._/-]*$")
    message: str = Field(min_length=1, max_length=10_000)
    files: dict[str, str | None] = Field(min_length=1, max_length=100)


@router.get("/git/{lab}/info/refs", **needs("viewer"))
async def refs(request: Request, lab: str, service: Service) -> Response:
    """Tell git which branches there are."""
    if service == "git-receive-pack":
        request.state.principal.require("operator", lab)
    return await _git(request, lab, "info/refs", QUERY_STRING=f"service={service}")


@router.post("/git/{lab}/git-upload-pack", **needs("viewer"))
async def fetch(request: Request, lab: str) -> Response:
    """Give git what it fetches."""
    return await _git(request, lab, "git-upload-pack")


@router.post("/git/{lab}/git-receive-pack", **needs("operator"))
async def push(request: Request, lab: str) -> Response:
    """Take what git pushes."""
    return await _git(request, lab, "git-receive-pack")


@router.post("/labs/{lab}/edits", **needs("operator"))
async def edit(request: Request, lab: str, wanted: Edit) -> dict[str, str]:
    """Commit manifests on a branch of one's own, `web/NAME`."""
    path = await _repository(request, lab)
    me: Principal = request.state.principal
    return await books(request.app).do(committed, path, me.name, wanted.base, wanted.files, wanted.message)


@router.get("/labs/{lab}/objects/{sha256}", **needs("viewer"))
async def get(request: Request, lab: str, sha256: str) -> Response:
    """Return large data by its SHA-256."""
    store = await _store(request, lab)
    if not store.has(sha256):
        raise PicoError(error("unknown-data", f"there is no object {sha256[:16]} here"))
    return FileResponse(store.path(sha256), media_type="application/octet-stream")


@router.put("/labs/{lab}/objects/{sha256}", **needs("operator"))
async def put(request: Request, lab: str, sha256: str) -> dict[str, Any]:
    """Keep large data, which must have that SHA-256."""
    store = await _store(request, lab)
    store.path(sha256)
    data = await request.body()
    return {"sha256": await books(request.app).do(store.put, data, expected=sha256), "size": len(data)}


async def _git(request: Request, lab: str, service: str, **more: str) -> Response:
    path = await _repository(request, lab)
    asked = {
        "service": service, "REQUEST_METHOD": request.method, "REMOTE_USER": request.state.principal.name,
        "CONTENT_TYPE": request.headers.get("content-type", ""), "QUERY_STRING": "", **more,
    }  # fmt: skip
    for name, variable in (("content-encoding", "HTTP_CONTENT_ENCODING"), ("git-protocol", "GIT_PROTOCOL")):
        if name in request.headers:
            asked[variable] = request.headers[name]
    return _Answered(await answered(path, asked, _body(request), request.app.state.git))


class _Answered(StreamingResponse):
    """What git answers; git ends with it."""

    def __init__(self, answer: Answer) -> None:
        super().__init__(answer.pieces(), answer.status, answer.headers)
        self._answer = answer

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await super().__call__(scope, receive, send)
        finally:
            self._answer.end()


async def _body(request: Request) -> AsyncIterator[bytes]:
    async for piece in request.stream():
        if piece:
            yield piece


async def _repository(request: Request, lab: str) -> Path:
    held = books(request.app)
    await _require_lab(request, lab)
    return await held.do(repository, held.folder, lab)


async def _store(request: Request, lab: str) -> Store:
    await _require_lab(request, lab)
    return Store(books(request.app).folder / "data" / lab)


async def _require_lab(request: Request, lab: str) -> None:
    """Raise PicoError (status 404) for a lab of which no bench is enrolled."""
    if lab not in {name.partition("/")[0] for name in books(request.app).leases.enrolled()}:
        raise PicoError(error("unknown-lab", f"no bench of a lab {lab[:64]} is enrolled here"))
