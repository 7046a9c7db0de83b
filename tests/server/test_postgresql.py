"""The store on a real PostgreSQL, as several coordinators share it: there row locks do what one writer does for SQLite.

A cluster of its own is made and started where its binaries are, reached by a socket in its folder alone.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import insert, select

from pico.control.gate import Command, Record
from pico.control.leases import Asker
from pico.diagnostics import PicoError
from pico.server.access.principal import Right
from pico.server.store.commands import CommandRows
from pico.server.store.database import Database
from pico.server.store.leases import Leases
from pico.server.store.ordered import broken, read_audit, read_events
from pico.server.store.people import People
from pico.server.store.tables import benches, metadata

COORDINATORS, BENCH = 4, "shel/bench1"
NOBODY = 65534
"""As whom the cluster runs where this is root, which PostgreSQL refuses to be."""


def binaries() -> Path | None:
    """Return the folder of the newest PostgreSQL here, None where there is none."""
    found = shutil.which("initdb")
    debian = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: float(path.parts[-3]))
    return Path(found).parent if found else debian[-1].parent if debian else None


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """Start a cluster, and yield the URL of its database."""
    at = binaries()
    if at is None:
        pytest.skip("no PostgreSQL on this machine (Debian: `apt install postgresql`)")
    pytest.importorskip("psycopg", reason="the driver of PostgreSQL is not installed (`pip install psycopg[binary]`)")
    root = os.geteuid() == 0
    if root and not shutil.which("setpriv"):
        pytest.skip("PostgreSQL does not run as root, and there is no `setpriv`")
    as_nobody = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"] if root else []
    folder = Path(tempfile.mkdtemp(prefix="pg-", dir="/tmp"))  # the path of a socket must be short
    if root:
        os.chown(folder, NOBODY, NOBODY)
    data = folder / "data"
    made = [at / "initdb", "-D", data, "-A", "trust", "-U", "pico", "--no-sync", "-E", "UTF8", "--locale=C"]
    subprocess.run([*as_nobody, *map(str, made)], check=True, capture_output=True, cwd=folder)
    options = ["-D", data, "-k", folder, "-c", "listen_addresses=", "-c", "fsync=off"]
    log = (folder / "log").open("wb")
    serving = subprocess.Popen([*as_nobody, *map(str, [at / "postgres", *options])], stdout=log, stderr=log, cwd=folder)
    try:
        url = f"postgresql+psycopg://pico@/postgres?host={folder}"
        yield _answering(url, serving, folder)
    finally:
        serving.send_signal(signal.SIGINT)
        serving.wait()
        log.close()
        shutil.rmtree(folder)


def _answering(url: str, serving: subprocess.Popen[bytes], folder: Path) -> str:
    import psycopg

    while serving.poll() is None:
        try:
            psycopg.connect(f"host={folder} user=pico dbname=postgres", connect_timeout=5).close()
            return url
        except psycopg.OperationalError:
            threading.Event().wait(0.05)
    raise AssertionError((folder / "log").read_text())


@pytest.fixture
def databases(cluster: str) -> Iterator[list[Database]]:
    """The database as each of several coordinators has opened it, with nothing in it but a bench."""
    found = [Database(cluster) for _ in range(COORDINATORS)]
    with found[0].writing() as connection:
        for table in reversed(metadata.sorted_tables):
            connection.execute(table.delete())
        connection.execute(insert(benches).values(bench=BENCH, enrolled_at=0.0))
    Leases(found[0]).heard(BENCH, 0)
    yield found
    for database in found:
        database.close()


def at_once(work: Callable[[int], Any], count: int = COORDINATORS) -> list[Any]:
    """Do something in several threads that begin together, and return what they give."""
    ready = threading.Barrier(count)

    def begun(number: int) -> Any:
        ready.wait()
        return work(number)

    with ThreadPoolExecutor(count) as threads:
        return list(threads.map(begun, range(count)))


def test_coordinators_that_grant_at_once_give_each_number_once(databases: list[Database]) -> None:
    def takes(number: int) -> list[int]:
        leases, given = Leases(databases[number]), list[int]()
        asker = Asker(f"u{number}/s", f"u{number}")
        while len(given) < 10:
            grant = leases.asked(BENCH, asker).row.grant
            if grant is None or grant.holder != asker:
                continue
            leases.heard(BENCH, grant.token)  # what its edge says once it has fenced
            given.append(grant.token)
            leases.released(BENCH, asker.session, grant.token)
        return given

    given = at_once(takes)
    assert len({token for tokens in given for token in tokens}) == 10 * COORDINATORS
    assert all(tokens == sorted(tokens) for tokens in given)
    with databases[0].reading() as connection:
        assert broken(connection) is None
        audit, events = read_audit(connection), read_events(connection, 0)
    granted = [entry["token"] for entry in audit if entry["deed"] == "granted"]
    assert granted == sorted(set(granted)) and len(granted) >= 10 * COORDINATORS
    assert [event["number"] for event in events] == list(range(1, len(events) + 1))


def test_a_command_that_coordinators_submit_at_once_is_one(databases: list[Database]) -> None:
    asker = Asker("anna/s", "anna")
    grant = Leases(databases[0]).asked(BENCH, asker).row.grant
    assert grant is not None

    def submits(number: int) -> list[tuple[str, int]]:
        rows = CommandRows(databases[number])
        return [(key, rows.submitted(BENCH, grant.token, key, "d", "{}").command.seq)
                for key in (f"run/op{n}/1" for n in range(12))]  # fmt: skip

    found = at_once(submits)
    assert len({tuple(one) for one in found}) == 1, "each is told the same numbers"
    assert sorted(seq for _, seq in found[0]) == list(range(1, 13))
    rows = CommandRows(databases[1])
    with pytest.raises(PicoError, match="other content"):
        rows.submitted(BENCH, grant.token, "run/op0/1", "another", "{}")
    done = Command(grant.token, dict(found[0])["run/op0/1"], "run/op0/1", "d")
    rows.answered(BENCH, done.key, Record(done, "done", '{"value":1}'))
    assert CommandRows(databases[2]).submitted(BENCH, grant.token, done.key, "d", "{}").result == '{"value":1}'
    assert [sent.row.command.seq for sent in rows.due(BENCH, grant.token)] == list(range(2, 13))


def test_a_code_lets_in_once_whichever_coordinator_it_is_shown(databases: list[Database]) -> None:
    people = People(databases[0])
    people.settled("anna", [Right("*", "viewer")], by="test")
    code = people.issued("anna", 60.0, by="test", kind="code").secret
    found = at_once(lambda number: People(databases[number]).exchanged(code, "", 60.0))
    (made,) = [one for one in found if one is not None]
    session = people.opened(made.secret)
    assert session is not None
    known = People(databases[3]).seated(session.secret)
    assert known is not None and known.name == "anna"
    people.revoked(made.id, by="test")
    assert People(databases[2]).seated(session.secret) is None


def test_who_looks_for_what_is_over_does_not_wait_for_what_another_has_in_hand(databases: list[Database]) -> None:
    asker = Asker("anna/s", "anna")
    with databases[0].writing() as connection:
        connection.execute(insert(benches).values(bench="shel/bench2", enrolled_at=0.0, met=True))
    for bench in (BENCH, "shel/bench2"):
        Leases(databases[0]).asked(bench, asker)
    with databases[0].writing() as connection:
        connection.execute(benches.update().values(expires=0.0))
    assert set(Leases(databases[1]).due()) == {BENCH, "shel/bench2"}
    with databases[0].writing() as held:
        held.execute(select(benches).where(benches.c.bench == BENCH).with_for_update())
        assert Leases(databases[1]).due() == ("shel/bench2",)
    assert set(Leases(databases[1]).due()) == {BENCH, "shel/bench2"}
