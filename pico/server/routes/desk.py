"""Commands at desks, one route each, and those that last: listed, followed and cancelled."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from fastapi import Query, Request
from fastapi.responses import JSONResponse, Response, StreamingResponse
from pydantic import Field

from pico.diagnostics import ExitCode, PicoError, error
from pico.server.access.principal import Principal
from pico.server.desk.desks import Desks, Wanted
from pico.server.desk.jobs import About, Job
from pico.server.desk.words import COMMANDS, goes_on
from pico.server.routes.admitting import needs, routed, while_known
from pico.server.routes.people import Body

router = routed()
AT = "/labs/{lab}/desk"
NDJSON = "application/x-ndjson"


class Words(Body):
    """The words after the command's name, as one would type them; the session in whose name it is done, one of its own
    where none is said; the bench, the lab's first where none is said; a revision instead of the desk, which is left as
    it is; `detach`: whether to answer at once with what was begun, of a command that lasts."""

    words: list[str] = Field(default_factory=list, max_length=200)
    session: str = Field("", max_length=100)
    bench: str = Field("", max_length=64)
    at: str | None = Field(None, min_length=1, max_length=200, pattern="^[A-Za-z0-9][A-Za-z0-9._/^~-]*$")
    detach: bool = False


def _desks(request: Request) -> Desks:
    found: Desks = request.app.state.desks
    return found


def _route(name: str) -> None:
    command = COMMANDS[name]

    async def run(request: Request, lab: str, asked: Words) -> Response:
        me: Principal = request.state.principal
        desks = _desks(request)
        wanted = Wanted(lab, name, asked.words, asked.session, asked.bench, asked.at)
        lasting = goes_on(name, asked.words)
        if asked.detach and not lasting:
            raise PicoError(error("usage", f"`pico {name}` is over at once", hint="without `detach`"))
        job = await desks.begin(me, wanted)
        if asked.detach:
            return JSONResponse({"run": job.about.id}, 202)
        headers = {"x-pico-run": job.about.id} if lasting else None
        return StreamingResponse(while_known(request, me, desks.followed(job)), headers=headers, media_type=NDJSON)

    lasts = " It goes on though nobody listens; `x-pico-run` names it." if command.lasting else ""
    said = (
        f"Run `pico {name}` at one's desk, and answer as it does with `--json`, a document a line, last how it ended."
    )
    path = f"{AT}/{name.replace(' ', '/')}"
    router.add_api_route(
        path, run, methods=["POST"], name=f"desk {name}", description=said + lasts, response_model=None,
        **needs(command.role),
    )  # fmt: skip


for one in COMMANDS:
    _route(one)


@router.get(f"{AT}/runs", **needs("viewer"))
async def listed(request: Request, lab: str) -> dict[str, Any]:
    """List the commands that last, the latest first; `exit` is null of those that go on."""
    found = [job.about for job in _desks(request).runs.values() if job.about.lab == lab]
    return {"runs": [shown(about) for about in sorted(found, key=lambda about: -about.began_at)]}


@router.get(f"{AT}/runs/{{run}}", **needs("viewer"))
async def one_of_them(request: Request, lab: str, run: str) -> dict[str, Any]:
    """Tell about one of them."""
    return shown(_run(request, lab, run).about)


@router.get(f"{AT}/runs/{{run}}/events", **needs("viewer"))
async def events(request: Request, lab: str, run: str, since: Annotated[int, Query(ge=0)] = 0) -> Response:
    """Follow one of them: the lines that it says after the first `since`, last how it ended."""
    job = _run(request, lab, run)
    lines = while_known(request, request.state.principal, _desks(request).followed(job, since))
    return StreamingResponse(lines, media_type=NDJSON)


@router.delete(f"{AT}/runs/{{run}}", **needs("operator"))
async def cancel(request: Request, lab: str, run: str) -> dict[str, Any]:
    """End one of them as Ctrl-C does, one's own; an admin may end everybody's. What moves is for `stop` to end."""
    job, me = _run(request, lab, run), request.state.principal
    if job.about.who != me.name and not me.may("admin", lab):
        text = f"{job.about.id} is a run of {job.about.who}"
        raise PicoError(error("forbidden", text, hint="`stop` ends what moves, whoever began it"), ExitCode.DENIED)
    _desks(request).cancel(job)
    return shown(job.about)


def shown(about: About) -> dict[str, Any]:
    """Return what is told of a run."""
    return asdict(about)


def _run(request: Request, lab: str, run: str) -> Job:
    job = _desks(request).runs.get(run)
    if job is None or job.about.lab != lab:
        raise PicoError(error("unknown-run", f"there is no run {run[:40]!r} of a desk of {lab[:64]}"))
    return job
