"""`pico gui`."""

from __future__ import annotations

import asyncio
from importlib.util import find_spec
from typing import Annotated

import typer

from pico.diagnostics import PicoError, error

from ..arguments import Fidelity
from ..session import Session
from ..views import gui as view

HEADING = "The simulator, and the rest"
ORDER = 190

Port = Annotated[int, typer.Option("--port", metavar="N", min=0, max=65535, help="At which port, 0 for a free one.")]
NoOpen = Annotated[bool, typer.Option("--no-open", help="Only tell the address; open no browser.")]


def gui(context: typer.Context, port: Port = 0, no_open: NoOpen = False, fidelity: Fidelity = None) -> None:
    """Open the lab of this folder in the browser, until Ctrl-C.

    The page is served to this machine alone, and its link works once. It works on this folder; commands in other
    terminals work on the same bench meanwhile. Exit code 5: somebody serves this bench already.

    Examples:
      pico gui
      pico gui --no-open --port 8700
    """
    if missing := [module for module in ("fastapi", "uvicorn", "sqlalchemy", "websockets") if not find_spec(module)]:
        raise PicoError(
            error("missing-extra", f"the page needs {', '.join(missing)}", hint="pip install 'pico-lab[gui]'")
        )
    from pico.manifest.load import find_lab, load_folder
    from pico.places.lab import own_folder
    from pico.server.app import create_app
    from pico.server.desk.desks import Desking
    from pico.server.running import listening, server
    from pico.server.store.books import books_in

    from ..runs.demonstration import served
    from ..runs.own_page import Page, opened, required_free
    from ..warm import WORDS

    session = Session.of(context)
    root = find_lab(session.folder)
    found = load_folder(root)
    if found.setup is None:
        raise PicoError(found.diagnostics)
    lab = found.setup.lab.name
    place = session.here(root)
    required_free(place)
    options = ("--fidelity", fidelity) if fidelity else ()

    def say(address: str) -> None:
        session.show(view, address, lab, not no_open and opened(address))

    with listening("127.0.0.1", port) as listener:
        books = books_in(own_folder(root) / "gui")
        try:
            url = f"http://127.0.0.1:{listener.getsockname()[1]}"
            page = Page(lab, place, books, url, options)
            asyncio.run(served(page, server(create_app(books, desks=Desking(WORDS, {lab: root}, url))), listener, say))
        finally:
            books.close()
    session.say("The page is closed.")
