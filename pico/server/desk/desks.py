"""The desks of a coordinator: whose command is run where, as whom, how many at a time, and for how long."""

from __future__ import annotations

import asyncio
import os
import secrets
import shutil
import signal
import time
from collections.abc import AsyncIterator, Coroutine, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.edge.network.remotes import Far, Remote
from pico.edge.network.session import runs_begun
from pico.server.access.principal import Principal, Right
from pico.server.access.secret import SAFELY
from pico.server.desk import places
from pico.server.desk.hiding import Hiding
from pico.server.desk.jobs import About, Job, code_of, forget_old, read
from pico.server.desk.warm import Warm
from pico.server.desk.words import COMMANDS, checked, goes_on
from pico.server.git.hosting import environment as git_environment
from pico.server.git.hosting import repository
from pico.server.store.books import Books
from pico.server.store.ordered import write_event
from pico.server.store.people import Issued

LASTS, LASTING = 120.0, 86400.0
"""How long a command goes on that is not a run, and one that is [s]."""
AT_ONCE, IN_ALL = 6, 24
"""How many commands somebody has going at once, and all together."""
FRESH = 1.0
"""How often it is asked whether who began a command is still let in [s]."""
AGAIN = 300.0
"""How long a token for commands that only look is used again [s]."""


@dataclass(frozen=True)
class Desking:
    """How there are desks: `warm` are the words that start the process which runs commands, none where there are no
    desks; `local`: the folders of labs whose desk is that folder itself, for the person at this machine; `url`: where
    commands reach the coordinator, a door of their own where it is empty."""

    warm: tuple[str, ...] = ()
    local: Mapping[str, Path] = field(default_factory=dict)
    url: str = ""


@dataclass(frozen=True)
class Wanted:
    """What somebody asks of a desk: `pico COMMAND WORDS...`, in a session of theirs, at the bench of a lab, on their
    desk or at a revision. `attended`: they follow it, and answer what it asks."""

    lab: str
    command: str
    words: Sequence[str]
    session: str
    bench: str = ""
    at: str | None = None
    attended: bool = False


class Desks:
    """All desks of a coordinator that keeps `books`; `url` is where their commands reach it."""

    def __init__(self, books: Books, desking: Desking, url: str) -> None:
        self._books, self._desking, self._url = books, desking, url
        self._folder = books.folder / "desks"
        self._warm = Warm(desking.warm)
        self._going: set[Job] = set()
        self._hiding = Hiding(books.folder)
        self._tokens: dict[tuple[str, frozenset[Right]], tuple[Issued, float]] = {}
        self._locks: dict[str, asyncio.Lock] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        found = [read(path) for path in sorted(self._folder.glob("*/runs/*"))]
        self.runs: dict[str, Job] = {job.about.id: job for job in found if job is not None}
        """The commands that last, by their ids."""

    async def begin(self, me: Principal, wanted: Wanted) -> Job:
        """Begin a command, and return it; raises PicoError before anything begins."""
        words = checked(wanted.command, wanted.words)
        session = me.asker(wanted.session or f"desk-{secrets.token_hex(6)}").session.partition("/")[2]
        bench = self._bench(wanted)
        self._require_room(me)
        job = Job(
            About(secrets.token_hex(6), wanted.lab, bench, me.name, wanted.command, words, time.time()),
            Path(), asyncio.Event(),
        )  # fmt: skip
        self._going.add(job)
        try:
            job.folder = self._made(job)
            place = await self._place(me, wanted, job)
            token = await self._token(me, job)
            folder = place if wanted.lab in self._desking.local else places.lab_in(place, wanted.lab)
            environment = self._environment(me, session, token.secret, job, wanted)
            confined = () if wanted.lab in self._desking.local else (place, self._bare(wanted.lab), job.folder)
            if goes_on(wanted.command, words):
                job.note()
                self.runs[job.about.id] = job
                for old in forget_old(self.runs, wanted.lab):
                    del self.runs[old]
            far = Far(Remote(self._url), wanted.lab, bench, folder)
            before = len(runs_begun(far.folder))
            full = ["--json", *wanted.command.split(" "), *words]
            job.number, ended = await self._warm.run(full, folder, environment, job.said, confined)
        except BaseException as exc:
            self._over(job)
            self.runs.pop(job.about.id, None)
            shutil.rmtree(job.folder, ignore_errors=True)
            if isinstance(exc, PicoError):
                raise self._hiding.error(exc) from exc
            raise
        self._keep(self._attend(job, ended, (me.token, token.id), place, (far.folder, before)))
        if goes_on(wanted.command, words):
            self._keep(self._announce(job.about, session))
        return job

    async def _announce(self, about: About, session: str) -> None:
        """Tell those who watch the bench that a command began there, in which session."""
        await self._books.do(self._write_event, about, session)
        self._books.announce()

    def _write_event(self, about: About, session: str) -> None:
        database = self._books.database
        with database.writing() as connection:
            data = {"run": about.id, "who": about.who, "command": about.command, "session": session}
            write_event(connection, database.now(connection), f"{about.lab}/{about.bench}", "desk", data)

    async def followed(self, job: Job, since: int = 0) -> AsyncIterator[bytes]:
        """Yield what a command says. One that only looks ends with who listens, and is forgotten with that. Raises
        PicoError for what says too much at once, which is ended."""
        command = COMMANDS[job.about.command]
        try:
            async for line in job.lines(since):
                yield line if job.about.lab in self._desking.local else self._hiding.of(line)
        except PicoError as exc:
            if not job.ended.is_set():
                job.about = replace(job.about, why=exc.diagnostics[0].summary)
                self.cancel(job)
            raise
        finally:
            if not job.ended.is_set() and command.role == "viewer":
                self._warm.signal(job.number, signal.SIGKILL)
            if not goes_on(job.about.command, job.about.words):
                self._keep(_forget(job))

    def cancel(self, job: Job) -> None:
        """End a command as Ctrl-C does."""
        self._warm.signal(job.number, signal.SIGINT)

    async def warm(self) -> None:
        """Load what commands need, so that the first one does not wait for that; nothing where there are no desks."""
        if self._desking.warm:
            await self._warm.started()

    async def close(self) -> None:
        """End all commands, as Ctrl-C does."""
        await self._warm.close()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for token, _ in self._tokens.values():
            await self._books.do(self._books.people.revoked, token.id, by="coordinator")

    def _require_room(self, me: Principal) -> None:
        mine = sum(job.about.who == me.name for job in self._going)
        if mine >= AT_ONCE or len(self._going) >= IN_ALL:
            who = f"{me.name} has" if mine >= AT_ONCE else "there are"
            text = f"{who} {mine if mine >= AT_ONCE else len(self._going)} commands going at desks"
            raise PicoError(error("limit", text, hint="wait until one has ended, or cancel one"))

    def _bench(self, wanted: Wanted) -> str:
        """Return the bench that is meant; raises PicoError where there is none."""
        there = [name.partition("/")[2] for name in self._books.leases.enrolled() if name.startswith(f"{wanted.lab}/")]
        if not there:
            raise PicoError(error("unknown-lab", f"no bench of a lab {wanted.lab[:64]} is enrolled here"))
        if wanted.bench and wanted.bench not in there:
            text = f"there is no bench {wanted.lab}/{wanted.bench[:64]}"
            raise PicoError(error("unknown-bench", text, hint=f"one of {', '.join(there)}"))
        return wanted.bench or there[0]

    def _made(self, job: Job) -> Path:
        """Return a folder for what a command says."""
        if goes_on(job.about.command, job.about.words):
            folder = self._folder / job.about.lab / "runs" / job.about.id
        else:
            folder = self._folder / job.about.lab / "once" / job.about.id
        (folder / "tmp").mkdir(mode=0o700, parents=True)
        return folder

    def _bare(self, lab: str) -> Path:
        return repository(self._books.folder, lab)

    async def _place(self, me: Principal, wanted: Wanted, job: Job) -> Path:
        """Return the folder where a command is run: for who may not change the lab, at its main branch."""
        if (local := self._desking.local.get(wanted.lab)) is not None:
            if wanted.at is not None:
                raise PicoError(
                    error("usage", "the desk of this lab is a folder, which is as it is", hint="without `at`")
                )
            return local
        bare, folder, command = self._bare(wanted.lab), self._folder / wanted.lab, COMMANDS[wanted.command]
        if wanted.at is not None and command.role != "viewer" and not goes_on(wanted.command, wanted.words):
            hint = "without `at`, on the desk"
            raise PicoError(error("usage", f"`pico {wanted.command}` changes no revision of the past", hint=hint))
        async with self._locks.setdefault(wanted.lab, asyncio.Lock()):
            if wanted.at is None and me.may("operator", wanted.lab):
                return await asyncio.to_thread(places.desk_of, bare, folder, me.name)
            commit = await asyncio.to_thread(places.commit_of, bare, wanted.at)
            if command.role == "viewer":
                return await asyncio.to_thread(places.looking_at, bare, folder, commit)
            branch = f"run/{me.name}/{job.about.id}"
            job.about = replace(job.about, commit=commit, branch=branch)
            return await asyncio.to_thread(places.begun_at, bare, folder, commit, branch)

    async def _token(self, me: Principal, job: Job) -> Issued:
        """Return a token by which a command speaks for somebody: with what they may by their own, and no more."""
        people, command = self._books.people, COMMANDS[job.about.command]
        known, until = self._tokens.get(key := (me.token, me.rights), (None, 0.0))
        looks = command.role == "viewer"
        if looks and known is not None and time.monotonic() < until:
            return known
        lasts = LASTING if goes_on(job.about.command, job.about.words) else LASTS + AGAIN
        label = "desk" if looks else f"desk: pico {job.about.command}"
        made = await self._books.do(
            people.issued, me.name, lasts, by=me.name, kind="look" if looks else "desk", label=label, scope=me.rights,
            parent=me.token,
        )  # fmt: skip
        if looks:
            now = time.monotonic()
            self._tokens = {other: kept for other, kept in self._tokens.items() if kept[1] > now}
            self._tokens[key] = made, now + AGAIN
        return made

    def _environment(self, me: Principal, session: str, token: str, job: Job, wanted: Wanted) -> dict[str, str]:
        """Return all that a command finds in its environment: of a person at this machine their own, else nobody's."""
        own = {
            "PICO_TOKEN": token, "PICO_SESSION": session,
            "PICO_BENCH": f"{self._url}/{job.about.lab}/{job.about.bench}",
            "TMPDIR": str(job.folder / "tmp"), "PAGER": "cat", "GIT_PAGER": "cat", "GIT_EDITOR": "false",
            "GIT_TERMINAL_PROMPT": "0", "OPENBLAS_NUM_THREADS": "1",
        }  # fmt: skip
        if goes_on(wanted.command, wanted.words):
            own |= {"PICO_QUESTIONS": str(job.folder), "PICO_ATTENDED": "yes" if wanted.attended else ""}
        if wanted.lab in self._desking.local:
            return {**os.environ, **own}
        mail = f"{me.name}@pico.invalid"
        home = str(job.folder / "tmp")
        return git_environment() | own | {
            "HOME": home, "XDG_CONFIG_HOME": home, "XDG_CACHE_HOME": home, "XDG_STATE_HOME": home, "LANG": "C.UTF-8",
            "LC_ALL": "C.UTF-8", "GIT_AUTHOR_NAME": me.name, "GIT_AUTHOR_EMAIL": mail, "GIT_COMMITTER_NAME": me.name,
            "GIT_COMMITTER_EMAIL": mail, "GIT_ALLOW_PROTOCOL": "",
        }  # fmt: skip

    async def _attend(
        self, job: Job, ended: asyncio.Future[int], tokens: tuple[str, str], place: Path, runs: tuple[Path, int]
    ) -> None:  # fmt: skip
        """Wait until a command has ended, and put away what it had."""
        command = COMMANDS[job.about.command]
        why = await self._until_ended(job, ended, tokens) or job.about.why
        status, new = ended.result(), runs_begun(runs[0])[runs[1] :]
        try:
            if command.role != "viewer":
                await self._books.do(self._books.people.revoked, tokens[1], by="coordinator")
            if job.about.branch:
                await asyncio.to_thread(places.remove, self._bare(job.about.lab), place)
        finally:  # on a full disk, too: nobody waits for it any more
            if goes_on(job.about.command, job.about.words):
                with suppress(PicoError):
                    job.note(exit=code_of(status), ended_at=time.time(), why=why, runs=new)
                shutil.rmtree(job.folder / "tmp", ignore_errors=True)
            else:
                job.about = replace(job.about, exit=code_of(status), why=why)
            self._over(job)

    async def _until_ended(self, job: Job, ended: asyncio.Future[int], tokens: tuple[str, str]) -> str:
        """Wait until a command has ended; end it where it goes on for too long, and as Ctrl-C does, with time for a
        safe end, once a token is over: the one by which it was begun, or its own. Return why it was ended."""
        loop, why = asyncio.get_running_loop(), ""
        until = loop.time() + (LASTING if goes_on(job.about.command, job.about.words) else LASTS)
        while not ended.done():
            if (left := until - loop.time()) <= 0:
                self._warm.signal(job.number, signal.SIGKILL)
                await ended
                return why or "it went on for too long"
            await asyncio.wait([ended], timeout=min(FRESH, left))
            if not ended.done() and not why and not await self._books.look(self._books.people.last, *tokens):
                why = "the token that it was begun with is over"
                self.cancel(job)
                until = min(until, loop.time() + SAFELY)
        return why

    def _over(self, job: Job) -> None:
        self._going.discard(job)
        job.ended.set()

    def _keep(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


async def _forget(job: Job) -> None:
    await job.ended.wait()
    await asyncio.to_thread(shutil.rmtree, job.folder, ignore_errors=True)
