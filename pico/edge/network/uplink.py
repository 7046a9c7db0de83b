"""The edge's own line to the coordinator that it is enrolled with: it dials out, asks how long its lease holds, does
what it is told under that lease, and once it is over brings the bench to where it may stay.

After both have shown that they have the key, the edge says `{"hello"}` and asks every second, and whenever something
changed, `{"poll": {"asked", "fenced", "moving"}}`; it is answered `{"lease": {"asked", "token", "left"}}`. Without
`asked` that is a hint to ask at once. How the bench was left when a lease was over it says (`left`) until that is
heard. A call says whom it is `by`, and the `command` that it is where it needs a lease.
"""

from __future__ import annotations

import asyncio
import json
import secrets
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from pico.base.state_files import GATE
from pico.control.gate import Command
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.lease import on_behalf_of
from pico.edge.link import wire
from pico.edge.link.answering import Answering, Taken
from pico.edge.local import LocalEdge
from pico.edge.network import messages
from pico.edge.network.enrolment import Enrolment
from pico.edge.network.granting import Granting, acting
from pico.edge.network.lapsing import left_safely, shut
from pico.edge.network.offline import offline
from pico.edge.network.settling import settled
from pico.model.record import as_json
from pico.version import __version__

if TYPE_CHECKING:
    from websockets.asyncio.client import ClientConnection

AGAIN = (0.1, 2.0)
"""Seconds after which the coordinator is dialled again: at first, and at most."""
MINDS = 0.02
"""Seconds between two looks at whether the lease is over."""
LATE = 3
"""Of so many questions that were not answered the times are kept."""
Document = dict[str, Any]


class Uplink:
    """The line of one edge."""

    def __init__(self, edge: LocalEdge, enrolment: Enrolment, say: Callable[[str], object] = lambda _: None) -> None:
        """`say`: is told when the line is there, when it is cut, and what hinders the edge. Raises PicoError where the
        edge can't keep what it must."""
        self._edge, self._enrolment, self._answering = edge, enrolment, Answering(edge)
        self.granting = Granting(GATE.path(edge.place.folder), edge.lock.last_token())
        edge.granted_by(self.granting)
        self._news = asyncio.Event()
        self._asked: dict[int, float] = {}
        self._number = 0
        self._calls: dict[str, tuple[asyncio.Task[None], Taken]] = {}
        self._giving: set[asyncio.Task[None]] = set()
        self._link: ClientConnection | None = None
        self._run: tuple[str, str, bool] | None = None  # what a command started, its key, whether in an open run
        self.wrong: tuple[Diagnostic, ...] = ()
        """What could not be done when a lease was over."""
        self._hindered: tuple[Diagnostic, ...] = ()
        """Why it can't fence for the next lease."""
        self._say, self._said = say, ""
        self._left: Document | None = None  # how the bench was left then, and by which question that was told
        self._left_told = 0
        self._told: tuple[str, ...] = ()  # the commands of earlier leases that the coordinator asked for

    async def run(self) -> None:
        """Dial, and dial again, for ever."""
        from websockets.exceptions import WebSocketException

        settled(self._edge, self.granting)
        if await self._edge.unended() is not None:  # nobody has had it in hand since
            self.wrong = await shut(self._edge, "the process of the edge was killed during a run")
        minding, wait = asyncio.create_task(self._mind()), AGAIN[0]
        try:
            while True:
                try:
                    await self._connected()
                except PicoError as exc:
                    self.wrong = tuple(exc.diagnostics)
                    self._tell(f"not connected: {exc.diagnostics[0].summary}")
                    wait = AGAIN[1]
                except (OSError, TimeoutError, WebSocketException, KeyError, TypeError, ValueError) as exc:
                    self._tell(f"cut off from {self._enrolment.url}, dialling again: {exc or type(exc).__name__}")
                    wait = min(2 * wait, AGAIN[1])
                else:
                    self._tell(f"cut off from {self._enrolment.url}, dialling again")
                    wait = AGAIN[0]
                self._link = None
                await asyncio.sleep(wait)
        finally:
            minding.cancel()
            self.granting.close()

    def _tell(self, text: str) -> None:
        """Say something that was not what was said last."""
        if text != self._said:
            self._said = text
            self._say(text)

    # the connection

    async def _connected(self) -> None:
        from websockets.asyncio.client import connect

        to, nonce = self._enrolment, secrets.token_hex(16)
        shown = messages.proof(bytes.fromhex(to.key), "dials", to.bench, nonce, "")
        options: dict[str, Any] = {"proxy": None} if to.is_local else {}
        options["additional_headers"] = {"Authorization": f"{messages.SCHEME} {to.bench} {nonce} {shown}"}
        if (context := to.context()) is not None:
            options["ssl"] = context
        async with connect(
            to.link, open_timeout=5, ping_interval=messages.PING, ping_timeout=messages.SILENT, close_timeout=1,
            max_size=messages.LONGEST, compression=None, **options,
        ) as link:  # fmt: skip
            if context is not None:
                to.require_pinned(link.transport.get_extra_info("ssl_object").getpeercert(True))
            await self._greet(link, nonce)
            self._link = link
            self._tell(f"connected to {to.url} as {to.bench}")
            asking = asyncio.create_task(self._ask(link))
            try:
                async for data in link:
                    await self._heard(messages.read(data))
            finally:
                asking.cancel()
                for call, (task, taken) in list(self._calls.items()):
                    if not taken.leases and not taken.runs:  # what was taken stays until its lease is over
                        task.cancel()
                        self._calls.pop(call)

    async def _greet(self, link: ClientConnection, mine: str) -> None:
        """Show each other that both have the key, then say who this is and what it remembers."""
        key, bench = bytes.fromhex(self._enrolment.key), self._enrolment.bench
        said = messages.read(await asyncio.wait_for(link.recv(), 10))
        theirs = str(said["nonce"])
        if not secrets.compare_digest(str(said["proof"]), messages.proof(key, "coordinator", bench, mine, theirs)):
            text = f"who answers at {self._enrolment.url} is not the coordinator that {bench} is enrolled with"
            raise PicoError(error("enrolment", text, hint="`pico edge enrol` enrols it anew"))
        gate = self.granting.gate
        able, lab = await self._edge.describe(), await self._edge.lab()
        hello = {
            "fenced": gate.memory.fenced, "records": self._records(said["open"]), "describe": as_json(able),
            "lab": lab is not None and able.lab_digest, "version": __version__,
        }  # fmt: skip
        proof = messages.proof(key, "edge", bench, mine, theirs)
        await link.send(messages.text({"proof": proof, "hello": hello}))

    async def _ask(self, link: ClientConnection) -> None:
        """Ask how long the lease holds, every second and whenever something changed."""
        self._asked.clear()
        while True:
            await self._poll(link)
            with suppress(TimeoutError):
                async with asyncio.timeout(messages.POLL):
                    while not self._news.is_set():  # what an answer has told of already is no news any more
                        await self._news.wait()

    async def _poll(self, link: ClientConnection) -> None:
        number = self._number = self._number + 1
        self._news.clear()
        self._asked[number] = self.granting.clock()
        self._asked.pop(number - LATE, None)
        left = {} if self._left is None else {"left": self._left}
        self._left_told = self._left_told or (number if left else 0)
        told: Document = {"records": self._records(self._told)} if self._told else {}
        if self._hindered:
            told["hindered"] = [one.summary for one in self._hindered]
        self._told = ()
        await link.send(messages.text({"poll": {"asked": number, **self._state(), **left, **told}}))

    def _records(self, keys: Iterable[str]) -> list[Document]:
        """Return what is known of commands; those that never came are not in it."""
        known = self.granting.gate.memory.records
        return [asdict(known[key]) for key in keys if key in known]

    def _state(self) -> Document:
        """Return what the coordinator is told: for which token the bench is fenced, how many commands of it were taken
        on, whether one is under way, and which run goes on by itself."""
        gate = self.granting.gate
        moving = self._run[0] if self._run is not None and not self._run[2] else None
        return {"fenced": gate.memory.fenced, "taken": gate.memory.taken, "busy": bool(gate.running), "moving": moving}

    async def _heard(self, said: Document) -> None:
        if "lease" in said:
            lease = said["lease"]
            if "asked" not in lease:
                self._news.set()
            elif (asked := self._asked.pop(int(lease["asked"]), None)) is not None:
                self.granting.heard(int(lease["token"]), float(lease["left"]), asked)
                if said.get("open"):
                    self._told = tuple(str(key) for key in said["open"])
                    self._news.set()
                if 0 < self._left_told <= int(lease["asked"]):  # how the bench was left is known there
                    self._left, self._left_told = None, 0
        elif said.get("close"):
            await self._let_go(str(said["id"]))
        elif "call" in said:
            call, taken = str(said["id"]), Taken()
            task = asyncio.create_task(self._call(call, said, taken))
            self._calls[call] = (task, taken)

    async def _send(self, document: Mapping[str, Any]) -> None:
        """Say something; what has changed is said before."""
        await self._over()
        if self._link is not None:
            if self._news.is_set():
                await self._poll(self._link)
            await self._link.send(messages.text(document))

    # what is called

    async def _let_go(self, call: str) -> None:
        task, taken = self._calls.pop(call, (None, Taken()))
        if task is not None:
            task.cancel()
        giving = asyncio.create_task(self._given_back(call, taken))  # it waits for what moves; the line must not
        self._giving.add(giving)
        giving.add_done_callback(self._giving.discard)

    async def _given_back(self, call: str, taken: Taken) -> None:
        from websockets.exceptions import ConnectionClosed

        await taken.let_go(self._edge)
        with suppress(ConnectionClosed):
            await self._send({"id": call, "closed": True})

    async def _call(self, call: str, said: Document, taken: Taken) -> None:
        from websockets.exceptions import ConnectionClosed

        try:
            with on_behalf_of(str(said.get("by", {}).get("who", "")) or "somebody at the coordinator"):
                async for answer in self._answers(said, taken):
                    await self._send({"id": call, **answer})
        except ConnectionClosed:  # it is asked again, and what was a command is answered then
            pass
        finally:
            if not taken.leases and not taken.runs:
                self._calls.pop(call, None)

    async def _answers(self, said: Document, taken: Taken) -> Any:
        try:
            name, arguments = wire.read_call(json.dumps(said).encode())
        except PicoError as exc:
            yield wire.failure(exc)
            return
        if name in wire.AT_TABLE:
            hint = "a person at the table calls `pico recover` at a terminal of the bench's own computer"
            yield wire.failure(PicoError(error("at-table", f"{name} is not done over a network", hint=hint)))
            return
        if said.get("command"):
            yield await self._commanded(Command(**said["command"]), name, arguments, taken)
            return
        if name in messages.UNDER_LEASE:
            text = f"{name} is done under a lease of the coordinator only"
            yield wire.failure(PicoError(error("lease", text), ExitCode.LOCKED))
            return
        async for answer in self._answering.answers(name, arguments, taken):
            yield answer

    async def _commanded(self, command: Command, name: str, arguments: list[Any], taken: Taken) -> Document:
        """Do what a command says, once, and return what it is answered: what it was, where it is known."""
        await self._over()
        take, known, refused = self.granting.judged(command)
        if known is not None:
            return dict(known)
        if not take and self._run is not None and self._run[1] == command.key:
            return {"value": self._run[0]}
        if not take:
            return {"refused": refused}
        answer: Document = {}
        with acting(command.token):
            # nobody who goes away takes a command back that was taken on
            done = asyncio.create_task(self._done(name, arguments, taken))
        try:
            answer = await asyncio.shield(done)
        except asyncio.CancelledError:
            done.add_done_callback(lambda task: self._ended(command.key, name, arguments, task.result()))
            raise
        self._ended(command.key, name, arguments, answer)
        return answer

    async def _done(self, name: str, arguments: list[Any], taken: Taken) -> Document:
        async for answer in self._answering.answers(name, arguments, taken):
            return answer
        return {}

    def _ended(self, key: str, name: str, arguments: list[Any], answer: Document) -> None:
        """Write what a command was answered; one that started a run ends with that."""
        if name == "start" and "value" in answer and self._edge.runs.started.goes_on_with(answer["value"]):
            self._run = (str(answer["value"]), key, arguments[0].within is not None)
            self.granting.declared(offline(self._edge.setup, arguments[0].plan))
        else:
            self.granting.ended(key, answer, durable=name != "execute")  # of an operation the journal has it
        if name != "execute":  # which changes nothing that the coordinator goes by before the next question
            self._news.set()

    async def _over(self) -> None:
        """End the command whose run is over."""
        if self._run is not None and not self._edge.runs.started.goes_on_with(self._run[0]):
            (run, key, _), self._run = self._run, None
            self.granting.declared(0.0)
            self.granting.ended(key, {"value": run})
            self._news.set()

    # the lease

    async def _mind(self) -> None:
        """Fence for the next lease once nothing moves, and leave the bench safely where one is over."""
        while True:
            await asyncio.sleep(MINDS)
            try:
                await self._over()
                if self.granting.gate.pending:
                    await self._fence()
                    self._hindered = ()
                elif self.granting.lapsed:
                    await self._lapsed()
            except PicoError as exc:  # a full disk: it is tried again
                self.wrong = self._hindered = tuple(exc.diagnostics)
                self._tell(exc.diagnostics[0].summary)
                self._news.set()
                await asyncio.sleep(1.0)

    async def _fence(self) -> None:
        await self._edge.custody.drain()
        if await self._edge.holder() is None:
            await self._over()
            if self.granting.fence():
                self._news.set()

    async def _lapsed(self) -> None:
        idle = await self._edge.holder() is None
        withdrawn = self.granting.withdrawn
        self.granting.live = False
        if idle and withdrawn:
            return
        await self._edge.custody.drain()
        await self._over()
        self._news.set()
        self.wrong = await left_safely(self._edge, "the lease of its bench is over")
        self._left, self._left_told = {"at": self._edge.now(), "wrong": as_json(self.wrong)}, 0
        self._news.set()
