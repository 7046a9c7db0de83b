"""`pico serve`."""

from __future__ import annotations

import asyncio
import os
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.backends.devices import SIMULATOR
from pico.diagnostics import PicoError, error
from pico.places.bench import BenchPlace

from ..session import Session
from ..views import serving as view

HEADING = "The simulator, and the rest"
ORDER = 180

if TYPE_CHECKING:
    from pico.server.store.books import Books

Folder = Annotated[
    Path | None, typer.Option("--folder", metavar="DIR", help="Where its books are; of this user without it.")
]
Host = Annotated[str, typer.Option("--host", metavar="ADDRESS", help="Where to listen; beyond this machine with TLS.")]
Port = Annotated[int, typer.Option("--port", metavar="N", min=0, max=65535, help="At which port, 0 for a free one.")]
Certificate = Annotated[Path | None, typer.Option("--certificate", metavar="FILE", help="For TLS, in PEM form.")]
Key = Annotated[Path | None, typer.Option("--key", metavar="FILE", help="Of the certificate, in PEM form.")]
Demo = Annotated[
    str | None, typer.Option("--demo", metavar="NAME", help="With a bench in the twin: of an example, such as shel.")
]
Names = Annotated[
    list[str] | None,
    typer.Option("--name", metavar="HOST", help="A name that it answers to, besides localhost; may be given again."),
]


def serve(
    context: typer.Context, folder: Folder = None, host: Host = "127.0.0.1", port: Port = 8700,
    certificate: Certificate = None, key: Key = None, name: Names = None, demo: Demo = None,
) -> None:  # fmt: skip
    """Serve benches to people elsewhere, until Ctrl-C or SIGTERM: the coordinator of a laboratory.

    It keeps who has which bench, who may, and what was done; edges connect to it (`pico edge enrol`), and clients
    (`pico remote add`). The first time it prints a code to log in with as admin. Beyond this machine it listens with
    TLS alone. Exit code 5: something else listens there.

    Examples:
      pico serve --demo shel
      pico serve --host 0.0.0.0 --name lab.org --certificate lab.pem --key lab.key
    """
    if missing := [module for module in ("fastapi", "uvicorn", "sqlalchemy", "websockets") if not find_spec(module)]:
        text = f"serving needs {', '.join(missing)}"
        raise PicoError(error("missing-extra", text, hint="pip install 'pico-lab[server]'"))
    session = Session.of(context)
    if key and not certificate:
        raise PicoError(error("tls", "a key without a certificate serves nobody", hint="`--certificate FILE` names it"))
    if demo and certificate:
        raise PicoError(error("usage", "a demonstration is for this machine alone", hint="leave `--certificate` out"))
    place = session.folder / folder if folder else _own(f"demo-{demo}" if demo else "coordinator")
    asyncio.run(_serve(session, place, (host, port), (certificate, key), frozenset(name or ()), demo))


def _own(name: str) -> Path:
    state = os.environ.get("XDG_STATE_HOME")
    return (Path(state) if state else Path.home() / ".local/state") / "pico" / name


async def _serve(
    session: Session, folder: Path, at: tuple[str, int], tls: tuple[Path | None, Path | None], names: frozenset[str],
    demo: str | None,
) -> None:  # fmt: skip
    from pico.server.app import create_app
    from pico.server.desk.desks import Desking
    from pico.server.guard.addresses import LOOPBACK, is_loopback
    from pico.server.running import listening, server
    from pico.server.store.books import books_in
    from pico.server.store.first import first_code

    from ..warm import WORDS

    secure = tls[0] is not None
    if demo is not None:
        from pico.history.examples.example import require_example

        require_example(demo)
    with listening(*at, tls=secure) as listener:
        books = books_in(folder)
        try:
            known = LOOPBACK | names | (frozenset() if is_loopback(at[0]) else {at[0]})
            app = create_app(books, known, desks=Desking(WORDS))
            if app.state.faults:
                session.report(app.state.faults)
            serving = server(app, *tls)
            shown = min(names) if names and secure else "localhost" if is_loopback(at[0]) else at[0]
            bare = f"[{shown}]" if ":" in shown else shown
            url = f"{'https' if secure else 'http'}://{bare}:{listener.getsockname()[1]}"
            if demo is None:
                session.show(view, url, folder, first_code(books.people))
                await serving.serve(sockets=[listener])
            else:
                await _demonstrate(session, serving, listener, books, url, demo)
        finally:
            books.close()
    session.say(
        "The coordinator has ended; runs go on at their edges." if demo is None else "The demonstration is over."
    )


async def _demonstrate(session: Session, serving: Any, listener: Any, books: Books, url: str, lab: str) -> None:
    """Serve with a bench that is not there."""
    from ..runs.demonstration import Demonstration, served

    shown = Demonstration(lab, BenchPlace(books.folder / lab, SIMULATOR), books, url)
    shown.make()
    await served(shown, serving, listener, lambda told: session.show(view, url, books.folder, None, told))
