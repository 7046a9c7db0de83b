"""Hands calls of clients on to edges: who may, under which lease, written before it is sent, sent again until it is
answered.

A lease that a call needs is asked for in the name of its session and for that call alone (`anna/s1~4f`), unless the
session has taken the bench itself (`anna/s1`). It is renewed while the call lasts, for `acquire` and `open` until their
client lets go of them or is gone, and for `start` by the run that it began, whoever listens.
"""

from __future__ import annotations

import asyncio
import json
import os
import secrets
from collections.abc import AsyncIterator, Coroutine, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from pico.base import clock
from pico.control.gate import Command, Record
from pico.control.leases import HEARTBEAT, Asker, Grant, Turn
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.link import wire
from pico.edge.network.messages import UNDER_LEASE, content, is_last
from pico.edge.network.roles import role_of
from pico.edge.open_run import not_open
from pico.server.access.principal import Principal
from pico.server.relay.hub import Gone, Hub
from pico.server.store.books import Books
from pico.server.store.commands import CommandRows

Document = Mapping[str, Any]
AWAY, LASTING_AWAY = 10.0, 60.0
"""Seconds in which an edge that is cut off comes back, for who looks, and for who waits for what it does."""
LASTING = frozenset({"report", "events", "film", "finish", "execute", "leave"})
FENCES = 60.0
"""Seconds in which an edge drains and fences."""
HINDERED = 3.0
"""Seconds after which somebody is told what hinders an edge from getting ready for their lease."""
AGAIN = 0.05
"""Seconds after which a command is sent again that could not be taken on yet."""
TAKEN = "pico lease take"
"""What a bench is taken for where nothing goes on under a lease."""
KEPT = frozenset({"acquire", "open"})
"""Calls that keep their lease once they are answered."""


@dataclass
class Call:
    """A call of a client: whose, in which session, at which bench, and what it took."""

    who: Principal
    session: str
    bench: str
    name: str
    arguments: list[Any]
    id: str
    held: Held | None = None
    reached: bool = False
    """Whether its edge has heard of it, and goes on with it or keeps what it took."""

    @property
    def asker(self) -> Asker:
        return self.who.asker(self.session)


@dataclass(eq=False)
class Held:
    """A lease that the coordinator renews for a call, until it is given back."""

    bench: str
    session: str
    token: int
    call: str


class Dispatcher:
    """Hands calls on between the books and the connected edges."""

    def __init__(self, books: Books, hub: Hub) -> None:
        self._books, self.hub, self.rows = books, hub, CommandRows(books.database)
        self._held: set[Held] = set()
        self._sending: dict[tuple[str, str], asyncio.Task[Document]] = {}
        self._apart: set[asyncio.Future[Any]] = set()
        self._cancelled: dict[tuple[str, str], asyncio.Event] = {}

    def call(self, who: Principal, session: str, bench: str, name: str, arguments: list[Any]) -> Call:
        """Return a call that may be made; raises PicoError for one that there is not, and one that the principal may
        not make."""
        if name not in wire.CALLS or name in wire.AT_TABLE:
            raise PicoError(error("link", f"this is no call that an edge knows: {name[:40]}"))
        who.require(role_of(name, arguments) or "any", bench.partition("/")[0])
        if len(arguments) != (wanted := len(wire.CALLS[name][0])):
            raise PicoError(error("link", f"{name} takes {wanted} arguments, not {len(arguments)}"))
        call = Call(who, session, bench, name, _signed(name, arguments, who.name), self.hub.number())
        try:
            _key(call, 0), _patience(call), call.asker
            if name in ("execute", "start", "open"):
                _continues(call, call.asker, Grant(0, Asker(f"{call.asker.session}~", who.name), 0.0))
        except (LookupError, TypeError, ValueError, AttributeError) as exc:
            raise PicoError(error("link", f"{name} takes other arguments: {type(exc).__name__}")) from exc
        return call

    async def answers(self, call: Call) -> AsyncIterator[Document]:
        """Yield what answers a call; what went wrong is an answer, too."""
        try:
            if call.name in UNDER_LEASE:
                yield await self._commanded(call)
            elif call.name == "holder":
                yield await self._holder(call)
            else:
                if call.name == "cancel" and (waits := self._cancelled.get((call.bench, str(call.arguments[0])))):
                    waits.set()
                async for answer in self._relayed(call):
                    yield answer
        except PicoError as exc:
            yield wire.failure(exc)

    async def close(self, call: Call) -> None:
        """Let go of what a call took or follows: its client is gone, or says so. A run goes on."""
        if call.name == "start":
            return
        if call.reached and (line := self.hub.connected(call.bench)) is not None:
            await line.let_go(call.id)
        if call.held is not None:
            await self._give_back(call.held)

    def turned(self, bench: str, turn: Turn) -> None:
        """Hear that a lease changed hands, which the edge is to know at once."""
        if turn.audit:
            self._aside(self.hub.hinted(bench, turn.row.token))

    # what needs no lease

    async def _relayed(self, call: Call) -> AsyncIterator[Document]:
        arguments, patience = call.arguments, LASTING_AWAY if call.name in LASTING else AWAY
        while True:
            line = await self.hub.line(call.bench, patience)
            call.reached = True
            try:
                said = {"call": call.name, "with": arguments, "by": _by(call)}
                async for answer in line.answers(call.id, said):
                    if call.name == "events" and "next" in answer:
                        arguments = [arguments[0], answer["next"]["seq"]]
                    call.reached = not is_last(answer) or call.name == "hold"
                    yield answer
                return
            except Gone:
                if call.name == "jog":  # what is late counts for nothing
                    raise PicoError(error("away", f"the edge of {call.bench} is not connected")) from None

    async def _holder(self, call: Call) -> Document:
        async for answer in self._relayed(call):
            row, _, since = await self._books.look(self._books.leases.shown, call.bench)
            grant = row.grant
            if answer.get("value", 0) is None and grant is not None and "~" not in grant.holder.session:
                return {"value": {
                    "token": grant.token, "user": grant.holder.who, "pid": os.getpid(), "since": _time(since),
                    "what": TAKEN, "server": True,
                }}  # fmt: skip
            return answer
        raise AssertionError("a call has an answer")

    # what needs one

    async def _commanded(self, call: Call) -> Document:
        """Do what needs a lease, under the one that there is for it or one for it alone. What is to be started is so
        also where who asked for it is gone meanwhile."""
        grant = await self._lease(call)
        doing = asyncio.create_task(self._under(call, grant))
        try:
            return await asyncio.shield(doing)
        except asyncio.CancelledError:
            if call.name != "start":
                doing.cancel()
            raise

    async def _under(self, call: Call, grant: Grant) -> Document:
        try:
            answer = await self._done(call, grant)
        except BaseException:
            await asyncio.shield(self._settle(call, keep=False))
            raise
        await self._settle(call, keep="value" in answer and (call.name in KEPT or call.name == "start"))
        if call.name == "finish":
            await self._finished(call, grant)
        return answer

    async def _settle(self, call: Call, *, keep: bool) -> None:
        held = call.held
        if held is not None and not keep:
            call.held = None
            await self._give_back(held)
        elif held is not None and call.name == "start":  # the run renews it from now on
            call.held = None
            self._held.discard(held)

    async def _finished(self, call: Call, grant: Grant) -> None:
        for held in [one for one in self._held if (one.bench, one.token) == (call.bench, grant.token)]:
            if held.session != call.asker.session:
                await self._give_back(held)

    async def _lease(self, call: Call) -> Grant:
        """Return the lease that a call is made under, once its edge has fenced for it; raises PicoError (exit code
        LOCKED) naming who has the bench."""
        leases, mine = self._books.leases, call.asker
        row, _, _ = await self._books.look(leases.shown, call.bench)
        grant = row.grant
        if grant is not None and grant.holder.session == mine.session:
            grant = await self._fenced(call, mine, 0.0)
        elif grant is None or not _continues(call, mine, grant):
            _require_own(call)
            own = Asker(f"{mine.session}~{secrets.token_hex(3)}", mine.who)
            grant = await self._fenced(call, own, _patience(call))
            call.held = Held(call.bench, own.session, grant.token, call.id)
            self._held.add(call.held)
        return grant

    async def _fenced(self, call: Call, asker: Asker, patience: float) -> Grant:
        leases, loop = self._books.leases, asyncio.get_running_loop()
        turned = asyncio.Event()
        end = self._books.listen(lambda bench, _: turned.set() if bench == call.bench else None)
        mine = (call.bench, str(call.arguments[1]) if call.name in ("start", "open") else call.id)
        cancelled = self._cancelled[mine] = asyncio.Event()
        until, began, grant = loop.time() + patience, loop.time(), None
        try:
            while True:
                turned.clear()
                if cancelled.is_set():
                    raise PicoError(error("interrupted", "interrupted; nothing has moved"), ExitCode.INTERRUPTED)
                row = (await self._books.turn(leases.asked, call.bench, asker)).row
                grant = row.grant if row.grant is not None and row.grant.holder == asker else None
                if grant is not None and grant.fenced:
                    return grant
                now = loop.time()
                if grant is None and row.grant is not None and now >= until:
                    raise PicoError(await self._in_use(call.bench), ExitCode.LOCKED)
                line = self.hub.connected(call.bench)
                why = line.hindered if line is not None else ""
                if (
                    now >= began + patience + FENCES
                    or (line is None and now >= began + AWAY)
                    or (why and grant is not None and now >= began + HINDERED)
                ):
                    await self.hub.line(call.bench, 0.0)
                    text = f"the edge of {call.bench} does not get ready for a lease{': ' if why else ''}{why}"
                    hint = (
                        "mend that beside the table; nothing has moved" if why else "`pico status` shows what it does"
                    )
                    raise PicoError(error("away", text, hint=hint), ExitCode.LOCKED)
                wait = HEARTBEAT if grant is not None or row.grant is None else min(HEARTBEAT, max(until - now, 0.0))
                await _first(wait, turned, cancelled)
        except BaseException:
            token = grant.token if grant is not None else 0
            await asyncio.shield(self._books.turn(leases.released, call.bench, asker.session, token))
            raise
        finally:
            end()
            self._cancelled.pop(mine, None)

    async def _in_use(self, bench: str) -> Any:
        row, _, since = await self._books.look(self._books.leases.shown, bench)
        who = row.grant.holder.who if row.grant is not None else "somebody"
        what, line = TAKEN, self.hub.connected(bench)
        with suppress(Gone, LookupError, TypeError):
            asked = {"call": "holder", "with": [], "by": {}}
            async for answer in line.answers(self.hub.number(), asked) if line is not None else _none():
                what = answer["value"]["what"]
        hint = "wait with `--lock-timeout SECONDS`; `pico lease show` says who is next; looking is always possible"
        return error("locked", f"the bench {bench} is in use by {who}, since {_time(since)}: {what}", hint=hint)

    async def _done(self, call: Call, grant: Grant) -> Document:
        """Write a command, send it until it is answered, and write what it was answered."""
        key, digest = _key(call, grant.token), content(call.name, call.arguments)
        said = {"call": call.name, "with": call.arguments, "by": _by(call), "id": call.id}
        rows = self.rows
        row = await self._books.look(rows.ended, call.bench, key, digest)
        if row is None:
            text = json.dumps(said, separators=(",", ":"))
            row = await self._books.do(rows.submitted, call.bench, grant.token, key, digest, text)
        if row.state != "waiting":
            return json.loads(row.result) if row.result else wire.failure(PicoError(_over(call.bench, grant.token)))
        call.reached = True
        answer = await asyncio.shield(self._sent(call.bench, row.command, said))
        call.reached = call.name in KEPT
        return answer

    def _sent(self, bench: str, command: Command, said: Document) -> asyncio.Task[Document]:
        """Return what sends a command, whoever waits for it."""
        mine = (bench, command.key)
        if mine not in self._sending:
            task = self._sending[mine] = asyncio.create_task(self._send(bench, command, said))
            task.add_done_callback(lambda _: self._sending.pop(mine, None))
            task.add_done_callback(lambda over: over.cancelled() or over.exception())
        return self._sending[mine]

    async def _send(self, bench: str, command: Command, said: Document) -> Document:
        number = str(said["id"])
        body = {**said, "command": {
            "token": command.token, "seq": command.seq, "key": command.key, "digest": command.digest,
        }}  # fmt: skip
        body.pop("id")
        if said["call"] == "start" and not said["with"][0].get("within"):
            await self._detached(bench, command.token, str(said["with"][1]))
        while True:
            answer: Document = {"refused": "away"}
            with suppress(Gone, PicoError):
                line = await self.hub.line(bench, HEARTBEAT)
                async for said_back in line.answers(number, body):
                    answer = said_back
            if "refused" not in answer:
                self._write(bench, Record(command, "done", json.dumps(answer, separators=(",", ":"))))
                return answer
            row, now, _ = await self._books.look(self._books.leases.shown, bench)
            if row.grant is None or row.grant.token != command.token or now > row.grant.expires:
                raise PicoError(_over(bench, command.token), ExitCode.LOCKED)
            if answer["refused"] == "conflict":
                raise PicoError(error("conflict", f"{command.key} is recorded with other content"))
            await asyncio.sleep(AGAIN)

    def _write(self, bench: str, record: Record) -> None:
        """Write what a command was answered. Nobody waits for that: its edge has it on its disk, and says so again
        where this coordinator ends before, or can't write now."""
        self._aside(self._books.do(self.rows.answered, bench, record.command.key, record))

    def _aside(self, work: Coroutine[Any, Any, Any]) -> None:
        """Have something done that nobody waits for."""
        task = asyncio.create_task(work)
        self._apart.add(task)
        task.add_done_callback(self._apart.discard)
        task.add_done_callback(lambda over: over.cancelled() or over.exception())

    async def _detached(self, bench: str, token: int, run: str) -> None:
        """Let a run that is to be started renew the lease that was asked for it."""
        row, _, _ = await self._books.look(self._books.leases.shown, bench)
        grant = row.grant
        own = grant is not None and grant.token == token and "~" in grant.holder.session and not grant.job
        if own and grant is not None and run:
            await self._books.turn(self._books.leases.detached, bench, grant.holder.session, token, run)

    async def resumed(self, bench: str) -> None:
        """Send again what an edge that has connected was not told of, under the lease that counts."""
        row, _, _ = await self._books.look(self._books.leases.shown, bench)
        if row.grant is not None:
            for due in await self._books.look(self.rows.due, bench, row.grant.token):
                self._sent(bench, due.row.command, json.loads(due.call))

    # leases that are held

    async def _give_back(self, held: Held) -> None:
        self._held.discard(held)
        await self._books.turn(self._books.leases.released, held.bench, held.session, held.token)

    async def renewing(self) -> None:
        """Renew what is held, for ever."""
        while True:
            await asyncio.sleep(HEARTBEAT)
            for held in list(self._held):
                turn = await self._books.turn(self._books.leases.renewed, held.bench, held.session, held.token)
                if any(said.what == "lost" and said.session == held.session for said in turn.said):
                    self._held.discard(held)


async def _first(seconds: float, *events: asyncio.Event) -> None:
    """Wait until one of some events has happened, at most so long."""
    waiting = [asyncio.create_task(event.wait()) for event in events]
    try:
        await asyncio.wait(waiting, timeout=seconds, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in waiting:
            task.cancel()


async def _none() -> AsyncIterator[Document]:
    return
    yield {}


def _continues(call: Call, mine: Asker, grant: Grant) -> bool:
    """Return whether a call goes on under a lease that another call of its session took."""
    if grant.holder.who != mine.who or not grant.holder.session.startswith(f"{mine.session}~"):
        return False
    if call.name == "execute":
        return bool(call.arguments[2]["token"] == grant.token)
    if call.name == "start":
        return bool(call.arguments[0].get("within")) or grant.job == call.arguments[1]
    return call.name == "finish"


def _require_own(call: Call) -> None:
    """Raise PicoError for a call that goes on under a lease which it has no more."""
    if call.name == "execute":
        text = f"the lease {call.arguments[2]['token']} of {call.arguments[2].get('holder')} is not the current one"
        raise PicoError(error("lease", text), ExitCode.LOCKED)
    if call.name == "finish":
        raise PicoError(not_open(str(call.arguments[0])), ExitCode.INTERRUPTED)


def _patience(call: Call) -> float:
    """Return how long a call waits for the bench [s]."""
    if call.name == "acquire":
        return float(call.arguments[1])
    return float(call.arguments[0].get("wait", 0.0)) if call.name in ("start", "open") else 0.0


def _key(call: Call, token: int) -> str:
    """Return what a command is known by: the same for the same asked again, under the same lease."""
    short = content(call.name, call.arguments)[-12:]
    if call.name in ("start", "open"):
        again = f".{call.id}" if call.arguments[0].get("resumes") else ""
        return f"{call.arguments[1]}/{call.name}/{token}.{short}{again}"
    return f"{call.arguments[1]}/{token}" if call.name == "execute" else f"{call.id}/{call.name}/{token}"


def _signed(name: str, arguments: list[Any], who: str) -> list[Any]:
    """Return the arguments with the name of who calls, where they name a person."""
    if name == "disarm" and len(arguments) == 2:
        return [arguments[0], who]
    if name == "resolve" and len(arguments) == 3:
        return [*arguments[:2], who]
    if name == "arm" and arguments and isinstance(arguments[0], dict):
        return [{**arguments[0], "by": who}]
    return arguments


def _over(bench: str, token: int) -> Diagnostic:
    text = f"the lease {token} of {bench} was over before this was done"
    return error("lease", text, hint="`pico status` shows what was done; `pico lease show` who has the bench")


def _by(call: Call) -> Document:
    return {"who": call.who.name, "session": call.session}


def _time(seconds: float) -> str:
    return clock.as_text(clock.from_epoch(seconds))
