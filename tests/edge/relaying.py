"""A coordinator in a process of its own, with the edge of one simulated bench that is enrolled with it, which lets
in who says TOKEN."""

from __future__ import annotations

import asyncio
import gc
import os
import secrets
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from pico.disk import write_whole
from pico.edge.link.server import edge_of
from pico.edge.network.remotes import Remote, Remotes, keep
from pico.places.bench import BenchPlace
from pico.places.choice import write_choice

TOKEN = "of-a-test"
BENCH = "shel/bench1"


async def _serve(root: Path, fidelity: str, ready: int, folder: Path) -> None:
    from sqlalchemy import update

    from pico.edge.network.enrolment import Enrolment
    from pico.edge.network.uplink import Uplink
    from pico.server.access.principal import ROLES, right
    from pico.server.access.secret import fingerprint
    from pico.server.app import create_app
    from pico.server.running import listening, server
    from pico.server.store.books import books_in
    from pico.server.store.edges import Edges
    from pico.server.store.tables import tokens

    books, listener = books_in(folder), listening("127.0.0.1", 0)
    books.people.settled("test", [right(role) for role in ROLES], by="test")
    books.people.issued("test", 3600.0, by="test")
    with books.database.writing() as connection:
        connection.execute(update(tokens).values(hash=fingerprint(TOKEN)))
    port, key = listener.getsockname()[1], secrets.token_hex(32)
    code, _ = Edges(books.database).invited(BENCH, "test")
    Edges(books.database).enrolled(code, key)
    write_whole(BenchPlace(root, "sim").folder / "enrolment.json", b"{}", folders=True)
    serving, edge = server(create_app(books)), edge_of(BenchPlace(root, "sim"), fidelity)
    uplink = asyncio.create_task(Uplink(edge, Enrolment(f"http://127.0.0.1:{port}", BENCH, key)).run())

    async def told() -> None:
        while not books.leases.met(BENCH):
            await asyncio.sleep(0.01)
        os.write(ready, b"%d\n" % port)

    telling = asyncio.create_task(told())
    await serving.serve(sockets=[listener])
    telling.cancel()
    uplink.cancel()
    with suppress(asyncio.CancelledError):
        await uplink
    await edge.close()
    (BenchPlace(root, "sim").folder / "enrolment.json").unlink()
    books.close()


def _slowed(pause: float) -> None:
    """Let each phase of what the simulated arm does last `pause` [s] longer, so that somebody can come in between."""
    from pico.backends.sim.session import WorldSession

    tell = WorldSession._tell

    def telling(self: WorldSession, *what: Any) -> None:
        tell(self, *what)
        time.sleep(pause)

    WorldSession._tell = telling  # type: ignore[method-assign]


@cache
def _import() -> None:
    """Load what coordinators need before they are forked: each would take half a second to do so."""
    from pico.edge.network import uplink  # noqa: F401
    from pico.server.app import create_app
    from pico.server.store.books import books_in

    with tempfile.TemporaryDirectory() as folder, closing(books_in(Path(folder))) as books:
        create_app(books).openapi()


@contextmanager
def relayed(root: Path, fidelity: str = "kinematic", *, pause: float = 0.0) -> Iterator[str]:
    """Serve the simulated bench of the lab in `root` as `shel/bench1` of a coordinator; yields its address.

    `pause`: so much longer lasts each phase of what its arm does [s].
    """
    _import()
    reading, writing = os.pipe()
    books = tempfile.TemporaryDirectory()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(reading)
            gc.freeze()  # nothing that was there before is looked through for garbage
            os.setsid()
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            if pause:
                _slowed(pause)
            asyncio.run(_serve(root, fidelity, writing, Path(books.name)))
            code = 0
        except BaseException as exc:
            print(f"the relay ended: {exc!r}", file=sys.stderr, flush=True)
        finally:
            os._exit(code)
    os.close(writing)
    try:
        yield f"http://127.0.0.1:{int(os.read(reading, 16))}"
    finally:
        os.close(reading)
        os.kill(child, signal.SIGTERM)
        os.waitpid(child, 0)
        books.cleanup()


def point(lab: Path, url: str, bench: str = "shel/bench1") -> None:
    """Let a checkout know a coordinator, and its bench as the one that is meant."""
    keep(lab, Remotes({"lab": Remote(url)}))
    write_choice(lab, f"lab/{bench}")
