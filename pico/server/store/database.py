"""The database of a coordinator: how it is opened, and the two ways to have a transaction on it.

SQLite in one process; by its URL PostgreSQL, which several coordinators share. Whoever writes locks the rows first that
it goes by: SQLite lets one write at a time (`BEGIN IMMEDIATE`), PostgreSQL locks rows (`FOR UPDATE`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, func, inspect, select
from sqlalchemy.engine import make_url
from sqlalchemy.exc import OperationalError

from pico.diagnostics import PicoError, error
from pico.server.store.tables import metadata

Clock = Callable[[], float]
"""Seconds since 1970."""


class Database:
    """The tables at a URL of SQLAlchemy; `clock` counts for SQLite alone, PostgreSQL has one for all coordinators."""

    def __init__(self, url: str, clock: Clock = time.time) -> None:
        self._clock = clock
        self.local = make_url(url).get_backend_name() == "sqlite"
        self._engine = _opened(url, self.local)
        self._writer = self._engine.execution_options(pico_writes="FULL")
        self._lazy = self._engine.execution_options(pico_writes="NORMAL")
        metadata.create_all(self._writer)
        self._widen()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """Read what is there, all of it as it was at one moment."""
        with self._engine.begin() as connection:
            yield connection

    @contextmanager
    def writing(self, *, durable: bool = True) -> Iterator[Connection]:
        """Write all or nothing: durable once the block has ended, undone where it raises. Not `durable`: it outlives
        this process, and a power failure once something later is durable; for what others know, and say again. Raises
        PicoError where the database can't be written, on a full disk say."""
        try:
            with (self._writer if durable else self._lazy).begin() as connection:
                if not durable and not self.local:
                    connection.exec_driver_sql("SET LOCAL synchronous_commit = off")
                yield connection
        except OperationalError as exc:
            text = f"the coordinator can't write its books: {exc.orig}"
            raise PicoError(error("books", text, hint="it needs room on its disk; STOP needs none")) from exc

    def _widen(self) -> None:
        """Add the column that tables made before it have not."""
        with self.writing() as connection:
            if "parent" not in {column["name"] for column in inspect(connection).get_columns("tokens")}:
                connection.exec_driver_sql("ALTER TABLE tokens ADD COLUMN parent VARCHAR(16)")

    def now(self, connection: Connection) -> float:
        """Return the time by the clock that leases go by [s since 1970]."""
        if self.local:
            return self._clock()
        return float(connection.execute(select(func.extract("epoch", func.clock_timestamp()))).scalar_one())

    def damaged(self) -> str:
        """Return what is wrong with the file of a database, empty for nothing."""
        if not self.local:
            return ""
        with self.reading() as connection:
            found = str(connection.exec_driver_sql("PRAGMA quick_check(1)").scalar_one())
        return "" if found == "ok" else found.splitlines()[0]

    def close(self) -> None:
        """Let go of the database."""
        self._engine.dispose()


def _opened(url: str, local: bool) -> Engine:
    if not local:
        return create_engine(url, isolation_level="READ COMMITTED", pool_pre_ping=True)
    engine = create_engine(url)

    @event.listens_for(engine, "connect")
    def durable(connection: Any, _record: Any) -> None:
        connection.isolation_level = None  # transactions begin as said below, not as the driver thinks
        for pragma in ("journal_mode = WAL", "foreign_keys = ON", "busy_timeout = 10000"):
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        if writes := connection.get_execution_options().get("pico_writes"):
            connection.exec_driver_sql(f"PRAGMA synchronous = {writes}")
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return engine
