"""The processes of a lab on the network, each forked from this one: the emulated table with its controllers, edge,
coordinator, the link between these two, the line of the clients, and clients. Each may be killed, frozen and started
anew."""

from __future__ import annotations

import asyncio
import os
import pickle
import secrets
import shutil
import signal
import socket
import sys
import threading
import time
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from network_links import CLEAR, WEATHER, Cable, Weather, link
from network_table import Entries, table

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
BENCH, TOKEN = "shel/bench1", "of-a-benchmark"


def forked(work: Callable[[], None]) -> int:
    """Do something in a process of its own, until it is killed; return its number."""
    child = os.fork()
    if child:
        return child
    try:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        work()
    except BaseException as exc:
        print(f"{work!r} ended: {exc!r}", file=sys.stderr, flush=True)
    finally:
        os._exit(1)


def free_port() -> int:
    """Return a port of 127.0.0.1 that nobody listens at."""
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


@asynccontextmanager
async def dialled(port: int, bench: str, key: str, fenced: int = 0) -> AsyncIterator[Any]:
    """Yield the link of an edge that has dialled a coordinator, and proved its key."""
    import json

    from websockets.asyncio.client import connect

    from pico.edge.network import messages

    secret, mine = bytes.fromhex(key), secrets.token_hex(16)
    shown = messages.proof(secret, "dials", bench, mine, "")
    async with connect(
        f"ws://127.0.0.1:{port}/api/edge/link", proxy=None, compression=None,
        additional_headers={"Authorization": f"{messages.SCHEME} {bench} {mine} {shown}"},
    ) as link:  # fmt: skip
        theirs = json.loads(await link.recv())["nonce"]
        proof = messages.proof(secret, "edge", bench, mine, theirs)
        await link.send(json.dumps({"proof": proof, "hello": {"fenced": fenced, "records": []}}))
        yield link


def edge(root: Path, note: Path | None) -> None:
    """Serve the bench of the lab in `root`: the table that `note` leads to, or a simulated one."""
    from pico.backends.hardware.opening import bench
    from pico.base.clock import now_ms as utc_now
    from pico.edge import own_lab
    from pico.edge.link.server import edge_of, serve
    from pico.edge.local import LocalEdge
    from pico.edge.network.enrolment import read_enrolment
    from pico.edge.network.uplink import Uplink

    enrolment = read_enrolment(BenchPlace(root, "sim"))
    assert enrolment is not None
    if note is None:
        found = edge_of(BenchPlace(root, "sim"), "kinematic")
    else:
        lab = own_lab.read(BenchPlace(root, "sim")) or own_lab.proposed(root)
        assert lab is not None

        def bring_up(*_: Any) -> Any:
            clock, entries = pickle.loads(note.read_bytes())
            return clock, Entries(entries)

        def opening(setup: Any) -> Any:
            return bench(setup, BenchPlace(root, "emulated"), "kinematic", utc_now, bring_up)

        found = LocalEdge(own_lab.setup_of(lab), BenchPlace(root, "sim"), opening, lab, utc_now)
    uplink = Uplink(found, enrolment)
    asyncio.run(serve(found, beside=uplink.run))


def coordinator(folder: Path, port: int) -> None:
    """Serve the books in a folder."""
    from pico.server.app import create_app
    from pico.server.running import listening, server
    from pico.server.store.books import books_in

    asyncio.run(server(create_app(books_in(folder))).serve(sockets=[listening("127.0.0.1", port)]))


@dataclass
class Network:
    """The lab in `folder`, and the processes that serve it by name. `emulated`: its table is emulated, in a process of
    its own. `cable`: to the namespace that edge and table are in, None where all are in one. `direct`: the edge dials
    the coordinator itself, by no link of ours."""

    folder: Path
    emulated: bool
    cable: Cable | None = None
    direct: bool = False
    running: dict[str, int] = field(default_factory=dict)
    frozen: set[str] = field(default_factory=set)
    weather: dict[str, Weather] = field(default_factory=lambda: {"link": Weather(), "line": Weather()})
    """What the link of the edge, and the line of the clients, are like."""

    def __post_init__(self) -> None:
        from pico.history.examples.example import make_example

        self.port, self.near = free_port(), free_port()
        self.far = self.port if self.direct else free_port()
        self.beside, self.checkout, self.books = (self.folder / n for n in ("beside", "checkout", "books"))
        make_example("shel", self.beside)
        make_example("shel", self.checkout)
        if self.emulated:
            for folder in (self.beside, self.checkout):
                shutil.copy(ROOT / "examples" / "devices.yaml", folder)
        self._enrol()
        from pico.edge.network.remotes import Remote, Remotes, keep
        from pico.places.choice import write_choice

        keep(self.checkout, Remotes({"lab": Remote(f"http://127.0.0.1:{self.near}")}))
        write_choice(self.checkout, f"lab/{BENCH}")
        os.environ["PICO_TOKEN"] = TOKEN

    def _enrol(self) -> None:
        import json
        from dataclasses import asdict

        from sqlalchemy import update

        from pico.edge.network.enrolment import Enrolment
        from pico.server.access.principal import ROLES, right
        from pico.server.access.secret import fingerprint
        from pico.server.store.books import books_in
        from pico.server.store.edges import Edges
        from pico.server.store.tables import tokens

        books, key = books_in(self.books), secrets.token_hex(32)
        books.people.settled("anna", [right(role) for role in ROLES], by="benchmark")
        books.people.issued("anna", 86400.0, by="benchmark")
        with books.database.writing() as connection:
            connection.execute(update(tokens).values(hash=fingerprint(TOKEN)))
        code, _ = Edges(books.database).invited(BENCH, "benchmark")
        Edges(books.database).enrolled(code, key)
        books.close()
        note = BenchPlace(self.beside, "sim").folder / "enrolment.json"
        note.parent.mkdir(parents=True, exist_ok=True)
        note.write_text(json.dumps(asdict(Enrolment(f"http://127.0.0.1:{self.far}", BENCH, key))))

    @property
    def note(self) -> Path | None:
        return self.folder / "table.pickle" if self.emulated else None

    @property
    def log(self) -> Path:
        """What the controllers of the table did."""
        return self.folder / "controllers.jsonl"

    def work(self) -> Mapping[str, Callable[[], None]]:
        """What each process does."""
        note, cable, weather = self.note, self.cable, self.weather
        here, port = ("127.0.0.1", self.port), self.far
        served: dict[str, Callable[[], None]] = {
            "coordinator": lambda: coordinator(self.books, self.port),
            "line": lambda: link(("127.0.0.1", self.near), here, weather["line"]),
            "link": lambda: link((cable.here if cable else "127.0.0.1", port), here, weather["link"]),
        }
        if self.direct:
            del served["link"]
        beside: dict[str, Callable[[], None]] = {}
        if note is not None:
            beside["table"] = lambda: table(self.beside, note, self.log)
        if cable:
            beside["plug"] = lambda: link(("127.0.0.1", port), (cable.here, port), Weather())
        beside["edge"] = lambda: edge(self.beside, note)
        return {**served, **{name: cable.beyond(one) if cable else one for name, one in beside.items()}}

    def start(self) -> None:
        """Start, or let go on, whatever does not, with links as they should be."""
        for one in self.weather.values():
            one.now = CLEAR
        if self.cable:
            self.cable.pull(False)
        for name in list(self.frozen):
            os.kill(self.running[name], signal.SIGCONT)
            self.frozen.discard(name)
        for name, work in self.work().items():
            if name not in self.running:
                self.running[name] = forked(work)
                if name == "table":
                    until((self.folder / "table.pickle").exists, 120)

    def ready(self) -> bool:
        """Wait until the coordinator answers, and the edge has come to it; return whether that is so."""
        return (
            until(lambda: answers(self.near), 120) and until(lambda: answers(self.port), 120) and until(self.met, 120)
        )

    def met(self) -> bool:
        """Return whether the edge has come to the coordinator."""
        import sqlite3

        books = sqlite3.connect(f"file:{self.books / 'coordinator.sqlite'}?mode=ro", uri=True, timeout=10)
        try:
            return any(met for (met,) in books.execute("SELECT met FROM benches"))
        finally:
            books.close()

    def kill(self, name: str) -> None:
        """Kill a process."""
        os.kill(self.running[name], signal.SIGKILL)
        os.waitpid(self.running.pop(name), 0)
        self.frozen.discard(name)

    def freeze(self, name: str) -> None:
        """Freeze a process."""
        os.kill(self.running[name], signal.SIGSTOP)
        self.frozen.add(name)

    def spoil(self, name: str, how: str) -> None:
        """Let a link go wrong."""
        if how == "pulled" and self.cable:
            self.cable.pull(True)
        else:
            self.weather[name].now = WEATHER[how]

    def close(self) -> None:
        """End all processes."""
        for name in list(self.running):
            self.kill(name)
        if self.cable:
            self.cable.close()


class Expiries:
    """Until when each lease was said to hold, at the latest, by the coordinator's books."""

    def __init__(self, books: Path) -> None:
        self._path, self._over = books / "coordinator.sqlite", threading.Event()
        self.known: dict[int, float] = {}
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def _watch(self) -> None:
        import sqlite3

        books = sqlite3.connect(f"file:{self._path}?mode=ro", uri=True, timeout=10)
        while not self._over.wait(0.02):
            with suppress(sqlite3.Error):
                for token, expires in books.execute("SELECT granted, expires FROM benches WHERE granted IS NOT NULL"):
                    self.known[token] = max(expires, self.known.get(token, 0.0))
        books.close()

    def close(self) -> None:
        """Watch no more."""
        self._over.set()
        self._thread.join()


def answers(port: int) -> bool:
    """Return whether somebody listens at a port."""
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
        return True
    return False


def until(true: Callable[[], bool], seconds: float) -> bool:
    """Wait until something is so; return whether it became so in time."""
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
