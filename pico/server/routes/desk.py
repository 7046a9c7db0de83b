"""Commands at desks, one route each, and those that last: listed, followed and cancelled."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from fastapi import Query, Request
from fastapi.responses import JSONResponse, Response, StreamingResponse
from pydantic import Field

from pico.diagnostics import ExitCode, PicoError, error
from pico.server.access.principal import Principal
from pico.server.desk.asking import answer, asked
from pico.server.desk.desks import Desks, Wanted
from pico.server.desk.jobs import Job
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

    async def run(request: Request, lab: str, said: Words) -> Response:
        me: Principal = request.state.principal
        desks = _desks(request)
        wanted = Wanted(lab, name, said.words, said.session, said.bench, said.at, not said.detach)
        lasting = goes_on(name, said.words)
        if said.detach and not lasting:
            raise PicoError(error("usage", f"`pico {name}` is over at once", hint="without `detach`"))
        job = await desks.begin(me, wanted)
        if said.detach:
            return JSONResponse({"run": job.about.id}, 202)
        headers = {"x-pico-run": job.about.id} if lasting else None
        return StreamingResponse(while_known(request, me, desks.followed(job)), headers=headers, media_type=NDJSON)

    lasts = " It goes on though nobody listens; `x-pico-run` names it." if command.lasting else ""
    told = (
        f"Run `pico {name}` at one's desk, and answer as it does with `--json`, a document a line, last how it ended."
    )
    path = f"{AT}/{name.replace(' ', '/')}"
    router.add_api_route(
        path, run, methods=["POST"], name=f"desk {name}", description=told + lasts, response_model=None,
        **needs(command.role),
    )  # fmt: skip


for one in COMMANDS:
    _route(one)


@router.get(f"{AT}/runs", **needs("viewer"))
async def listed(request: Request, lab: str) -> dict[str, Any]:
    """List the commands that last, the latest first; `exit` is null of those that go on, and `question` of those that
    ask nothing now."""
    found = [job for job in _desks(request).runs.values() if job.about.lab == lab]
    return {"runs": [shown(job) for job in sorted(found, key=lambda job: -job.about.began_at)]}


@router.get(f"{AT}/runs/{{run}}", **needs("viewer"))
async def one_of_them(request: Request, lab: str, run: str) -> dict[str, Any]:
    """Tell about one of them."""
    return shown(_run(request, lab, run))


@router.get(f"{AT}/runs/{{run}}/events", **needs("viewer"))
async def events(request: Request, lab: str, run: str, since: Annotated[int, Query(ge=0)] = 0) -> Response:
    """Follow one of them: the lines that it says after the first `since`, last how it ended."""
    job = _run(request, lab, run)
    lines = while_known(request, request.state.principal, _desks(request).followed(job, since))
    return StreamingResponse(lines, media_type=NDJSON)


@router.delete(f"{AT}/runs/{{run}}", **needs("operator"))
async def cancel(request: Request, lab: str, run: str) -> dict[str, Any]:
    """End one of them as Ctrl-C does, one's own; an admin may end everybody's. What moves is for `stop` to end."""
    job = _own(request, lab, run, "`stop` ends what moves, whoever began it")
    _desks(request).cancel(job)
    return shown(job)


class Answering(Body):
    """An answer to the question of an id, as one would type it at a terminal: `yes`, `30`, `30 deg`, one of the
    choices."""

    question: str = Field(pattern="^q[0-9]{1,9}$")
    answer: str = Field(max_length=10_000)


@router.post(f"{AT}/runs/{{run}}/answers", **needs("operator"))
async def answers(request: Request, lab: str, run: str, said: Answering) -> dict[str, Any]:
    """Answer what one of them asks, one's own; an admin may answer for everybody. 400 says what is wrong with an
    answer, and the question stays; 409 that it is not asked any more, for somebody has answered it or it is over."""
    job = _own(request, lab, run, "who began it answers what it asks, or an admin of the lab")
    value = answer(job, said.question, said.answer, request.state.principal.name)
    return {"question": said.question, "value": value}


def shown(job: Job) -> dict[str, Any]:
    """Return what is told of a run."""
    return {**asdict(job.about), "question": asked(job)}


def _own(request: Request, lab: str, run: str, hint: str) -> Job:
    """Return a run of who asks, to an admin any; raises PicoError with a hint to all others."""
    job, me = _run(request, lab, run), request.state.principal
    if job.about.who != me.name and not me.may("admin", lab):
        raise PicoError(error("forbidden", f"{job.about.id} is a run of {job.about.who}", hint=hint), ExitCode.DENIED)
    return job


def _run(request: Request, lab: str, run: str) -> Job:
    job = _desks(request).runs.get(run)
    if job is None or job.about.lab != lab:
        raise PicoError(error("unknown-run", f"there is no run {run[:40]!r} of a desk of {lab[:64]}"))
    return job
