"""Commands in the database: a row is there before anything is sent, and ends with what the edge answered.

What a change does is `pico.control.commands`; here the rows that it concerns are read and written.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, bindparam, insert, select, update
from sqlalchemy import func as sql

from pico.control import commands as control
from pico.control.commands import OPEN, Commands, Row
from pico.control.gate import Command, Memory, Record
from pico.diagnostics import ExitCode, PicoError, error
from pico.server.store.database import Database
from pico.server.store.tables import benches, commands

# made once: to put a statement together takes longer than to carry it out
_BENCH = commands.c.bench == bindparam("of")
_ROWS = select(commands).where(_BENCH)
_GRANTED = select(benches.c.granted).where(benches.c.bench == bindparam("of")).with_for_update()
_LAST = select(sql.max(commands.c.seq)).where(_BENCH & (commands.c.token == bindparam("under")))
_KNOWN = _ROWS.where(commands.c.key == bindparam("known_by"))
_OPEN = _ROWS.where(commands.c.state.in_(sorted(OPEN)))
_DUE = _ROWS.where((commands.c.token == bindparam("under")) & (commands.c.state == "waiting")).order_by(commands.c.seq)
_CHANGED = update(commands).where(_BENCH & (commands.c.key == bindparam("known_by")))


@dataclass(frozen=True)
class Sent:
    """A row, and what is sent for it, as JSON."""

    row: Row
    call: str


class CommandRows:
    """What was asked of each bench under its leases."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def submitted(self, bench: str, token: int, key: str, digest: str, call: str) -> Row:
        """Take a command on under the next number of its lease, or return the row that its key has. Raises PicoError
        (exit code LOCKED) where the lease is over, and for a known key with other content."""
        with self._database.writing() as connection:
            if connection.execute(_GRANTED, {"of": bench}).scalar() != token:
                text = f"the lease {token} of {bench} is over"
                raise PicoError(error("lease", text, hint="`pico lease show` says who has it"), ExitCode.LOCKED)
            known = _known(connection, bench, key)
            last = _last(connection, bench, token)
            command = known.command if known and known.command.digest == digest else None
            command = command or Command(token, last + 1, key, digest)
            try:
                row = control.submitted(Commands({key: known} if known else {}), command).rows[key]
            except ValueError as exc:
                raise PicoError(error("conflict", str(exc), hint="start it under a new id")) from exc
            if known is None:
                values = {"bench": bench, "key": key, "token": token, "seq": command.seq, "digest": digest}
                now = self._database.now(connection)
                connection.execute(insert(commands), {**values, "state": row.state, "call": call, "asked_at": now})
            return row

    def ended(self, bench: str, key: str, digest: str) -> Row | None:
        """Return the row of a command that has its end, None where there is none with this content: for that nothing
        needs to be written."""
        with self._database.reading() as connection:
            row = _known(connection, bench, key)
            return row if row and row.command.digest == digest and row.state not in OPEN else None

    def last(self, bench: str, token: int) -> int:
        """Return the number of the last command of a lease, 0 where there is none."""
        with self._database.reading() as connection:
            return _last(connection, bench, token)

    def answered(self, bench: str, key: str, record: Record) -> Row:
        """Write what the edge says of a command, and return its row. The edge has it on its disk, and says it again
        whenever it connects."""
        with self._database.writing(durable=False) as connection:
            before = _known(connection, bench, key)
            assert before is not None
            after = control.answered(Commands({key: before}), record)
            _write(connection, bench, Commands({key: before}), after)
            return after.rows[key]

    def open(self, bench: str, below: int | None = None) -> tuple[str, ...]:
        """Return the keys of a bench of which the edge has not told an end yet, or those of leases below one."""
        with self._database.reading() as connection:
            rows = _open(connection, bench).rows
        return tuple(key for key, row in rows.items() if below is None or row.command.token < below)

    def reconciled(self, bench: str, fenced: int, records: Iterable[Record]) -> None:
        """Bring what is open in line with what the edge remembers, as it says when it connects, and when
        it has fenced for another lease."""
        memory = Memory(fenced=fenced, records={record.command.key: record for record in records})
        with self._database.writing() as connection:
            before = _open(connection, bench)
            _write(connection, bench, before, control.reconciled(before, memory))

    def due(self, bench: str, token: int) -> tuple[Sent, ...]:
        """Return what is to be sent, or sent again, for the lease that counts, in order."""
        with self._database.reading() as connection:
            rows = connection.execute(_DUE, {"of": bench, "under": token})
            return tuple(Sent(_row(row), row.call) for row in rows)


def _last(connection: Connection, bench: str, token: int) -> int:
    return connection.execute(_LAST, {"of": bench, "under": token}).scalar() or 0


def _known(connection: Connection, bench: str, key: str) -> Row | None:
    found = connection.execute(_KNOWN, {"of": bench, "known_by": key}).first()
    return _row(found) if found else None


def _open(connection: Connection, bench: str) -> Commands:
    found = connection.execute(_OPEN, {"of": bench})
    return Commands({row.key: _row(row) for row in found})


def _row(found: Any) -> Row:
    return Row(Command(found.token, found.seq, found.key, found.digest), found.state, found.result, found.by)


def _write(connection: Connection, bench: str, before: Commands, after: Commands) -> None:
    for key, row in after.rows.items():
        if row != before.rows[key]:
            values = {"state": row.state, "result": row.result, "by": row.by}
            connection.execute(_CHANGED, {"of": bench, "known_by": key, **values})
