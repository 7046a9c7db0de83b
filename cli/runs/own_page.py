"""The page for the lab of a folder: a coordinator of this process, for this machine alone, and the bench at it."""

from __future__ import annotations

import asyncio
import contextlib
import getpass
import re
import webbrowser
from typing import TYPE_CHECKING

from pico.diagnostics import ExitCode, PicoError, error
from pico.places.bench import BenchPlace

from .demonstration import Demonstration

if TYPE_CHECKING:
    from pico.server.store.books import Books


def required_free(bench: BenchPlace) -> None:
    """Raise PicoError if a bench is another coordinator's, or somebody serves it already."""
    from pico.edge.link import place
    from pico.edge.network import remotes
    from pico.edge.network.enrolment import read_enrolment

    mine = remotes.known(bench.root).named.get(remotes.PAGE)  # puts back what a killed one left
    known = read_enrolment(bench)
    if known is not None and (mine is None or mine.url != known.url):
        hint = f"open {known.url} in the browser; `pico edge withdraw` takes the bench from there"
        raise PicoError(error("enrolled", f"this bench is enrolled as {known.bench} at {known.url}", hint=hint))
    if place.find(bench) is not None:
        text = "somebody serves this bench already"
        raise PicoError(
            error("locked", text, hint="end that first (`pico edge`, or another `pico gui`)"), ExitCode.LOCKED
        )


def person() -> str:
    """Return what the user of this machine is called at its own coordinator."""
    bare = re.sub(r"[^a-z0-9._-]+", "-", getpass.getuser().lower()).strip("._-")[:64]
    return bare or "me"


class Page:
    """The page for a bench of the lab called `lab`, at `url`; raises PicoError where another page has it."""

    def __init__(self, lab: str, place: BenchPlace, books: Books, url: str, options: tuple[str, ...]) -> None:
        from pico.edge.network.own_page import OwnPage

        self._books, self._url = books, url
        self._own = OwnPage(place, url)
        self._bench = Demonstration(lab, place, books, url, person(), options)

    async def begin(self) -> str:
        """Connect the bench, let commands in the folder go through the page's coordinator, and return the address of
        the page with a code in it that lets in once. Raises PicoError."""
        from pico.server.store.first import ADMIN

        shown = await self._bench.begin()
        made = await self._books.do(self._books.people.issued, person(), 86400.0, by=ADMIN, label="commands here")
        await asyncio.to_thread(self._own.mean, shown.bench, made.secret)
        return f"{self._url}/#code={shown.code}"

    def end(self) -> None:
        """Let the bench be its folder's own again."""
        self._bench.end()
        self._own.end()


def opened(address: str) -> bool:
    """Open an address in the user's browser; return whether there is one."""
    with contextlib.suppress(webbrowser.Error):
        return webbrowser.open(address)
    return False
