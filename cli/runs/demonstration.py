"""A bench at a coordinator of this process, its edge in a process of its own: of an example lab, or of one's own."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from pico.diagnostics import PicoError, error
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.server.store.books import Books

PERSON = "demo"
"""Whom the code that is printed lets in."""
JOINS = 120.0
"""Seconds in which the edge is connected."""
ENDS = 20.0
"""Seconds in which it ends: what moves comes to its safe end."""


@dataclass(frozen=True)
class Demonstrated:
    """An example `lab`, its `bench` at the coordinator, and the code by which a client logs in there."""

    lab: str
    bench: str
    code: str


class Demonstration:
    """The bench at `place`, of the lab called `lab`, at a coordinator that serves `books` at `url`; `person` is let in.
    `options`: of `pico edge`."""

    def __init__(
        self, lab: str, place: BenchPlace, books: Books, url: str, person: str = PERSON, options: tuple[str, ...] = ()
    ) -> None:
        self._lab, self._place, self._books, self._url = lab, place, books, url
        self._root = place.root
        self._person, self._options = person, options
        self._process: subprocess.Popen[bytes] | None = None

    def make(self) -> None:
        """Make the example where it is not there yet; raises PicoError for an example that there is not."""
        if not (self._root / ".git").exists():
            from pico.history.examples.example import make_example

            make_example(self._lab, self._root)
        from pico.server.git.hosting import repository

        bare = repository(self._books.folder, self._lab)
        for what in ("--all", "--tags"):  # what desks are made of
            subprocess.run(["git", "-C", self._root, "push", "--quiet", bare, what], check=False, capture_output=True)

    async def begin(self) -> Demonstrated:
        """Enrol the bench, if it is not yet, and connect its edge; raises PicoError."""
        from pico.edge.network.enrolment import enrol, read_enrolment
        from pico.server.access.principal import ROLES, Right
        from pico.server.store.edges import Edges
        from pico.server.store.first import ADMIN

        books, bench = self._books, f"{self._lab}/bench1"
        known = await asyncio.to_thread(read_enrolment, self._place)
        if known is None or known.url != self._url or bench not in books.leases.enrolled():
            code, _ = await books.do(Edges(books.database).invited, bench, ADMIN)
            await asyncio.to_thread(enrol, self._place, self._url, code)
        rights = [Right("*", "admin"), *(Right(self._lab, role) for role in ROLES if role != "admin")]
        await books.do(books.people.settled, self._person, rights, by=ADMIN)
        made = await books.do(
            books.people.issued, self._person, 86400.0, by=ADMIN, kind="code", label="on this machine"
        )
        words = [sys.executable, "-P", "-m", "pico_cli", "-C", str(self._root), "--bench", self._place.name]
        words += ["edge", "--with-input", *self._options]
        self._process = subprocess.Popen(  # the pipe ends with this process, whatever ends that
            words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, start_new_session=True
        )
        await self._joined(bench)
        return Demonstrated(self._lab, bench, made.secret)

    async def _joined(self, bench: str) -> None:
        """Wait until the edge has been heard of; raises PicoError where it ends before."""
        assert self._process is not None
        with suppress(TimeoutError):
            async with asyncio.timeout(JOINS):
                while not self._books.leases.met(bench):
                    if self._process.poll() is not None:
                        raise PicoError(error("edge", f"the edge of {bench} has ended ({self._process.returncode})"))
                    await asyncio.sleep(0.1)
                return
        raise PicoError(error("edge", f"the edge of {bench} did not connect within {JOINS:g} s"))

    def end(self) -> None:
        """End the edge, and wait until it has."""
        if self._process is None:
            return
        self._process.terminate()
        try:
            self._process.wait(ENDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class Beginning(Protocol):
    """What begins once a coordinator serves, and is told then; `end` undoes it."""

    async def begin(self) -> Any: ...

    def end(self) -> None: ...


async def served(shown: Beginning, serving: Any, listener: Any, say: Callable[[Any], None]) -> None:
    """Serve with a bench until SIGINT or SIGTERM; `say` is told what its beginning gave."""
    going = asyncio.create_task(serving.serve(sockets=[listener]))
    try:
        while not serving.started and not going.done():
            await asyncio.sleep(0.01)
        beginning = asyncio.create_task(shown.begin())
        await asyncio.wait([beginning, going], return_when=asyncio.FIRST_COMPLETED)
        if beginning.done():
            say(beginning.result())
        beginning.cancel()
        await going
    finally:
        serving.should_exit = True
        await asyncio.to_thread(shown.end)
        await asyncio.wait([going])
