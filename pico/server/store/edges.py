"""Edges in the database: the codes by which a bench is enrolled, each once, and the key that it then has."""

from __future__ import annotations

from sqlalchemy import delete, insert, select, update

from pico.diagnostics import PicoError, error
from pico.server.access.principal import require_name
from pico.server.access.secret import fingerprint, new_secret
from pico.server.store.database import Database
from pico.server.store.ordered import write_audit
from pico.server.store.tables import benches, edges, enrolments

LASTS = 3600.0
"""How long a code of enrolment lasts [s]."""


class Edges:
    """Which benches there are, and by which key the edge of each is known."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def invited(self, bench: str, by: str) -> tuple[str, float]:
        """Return a code with which the edge of a bench (`lab/name`) is enrolled once, and when it is over [s since
        1970]; raises PicoError for what can be no name."""
        lab, slash, name = bench.partition("/")
        if not slash:
            raise PicoError(
                error(
                    "usage",
                    f"`{bench[:80]}` names no bench",
                    hint=f"LAB/BENCH, such as `{bench[:64] or 'shel'}/bench1`",
                )
            )
        require_name(lab, "a lab")
        require_name(name, "a bench")
        code = new_secret("edge")
        with self._database.writing() as connection:
            over = self._database.now(connection) + LASTS
            row = {"hash": fingerprint(code), "bench": bench, "by": by, "expires_at": over}
            connection.execute(insert(enrolments).values(**row))
            write_audit(connection, over - LASTS, "invited", by, bench=bench)
        return code, over

    def enrolled(self, code: str, key: str) -> str:
        """Let the edge be known by `key` from now on that has a code, in place of the one before, and return its bench;
        raises PicoError for a code that is none, or none any more."""
        with self._database.writing() as connection:
            now, mine = self._database.now(connection), enrolments.c.hash == fingerprint(code)
            row = connection.execute(select(enrolments).where(mine).with_for_update()).first()
            if row is None or row.used_at is not None or row.expires_at <= now:
                text = "this code enrols nothing (any more)"
                raise PicoError(
                    error("unauthenticated", text, hint="an admin makes codes: `pico token enrol LAB/BENCH`")
                )
            connection.execute(update(enrolments).where(mine).values(used_at=now))
            there = connection.execute(select(benches.c.bench).where(benches.c.bench == row.bench)).first()
            if there is None:
                connection.execute(insert(benches).values(bench=row.bench, enrolled_at=now))
            connection.execute(delete(edges).where(edges.c.bench == row.bench))
            values = {"bench": row.bench, "key": key, "enrolled_at": now, "enrolled_by": row.by}
            connection.execute(insert(edges).values(**values))
            write_audit(connection, now, "enrolled", row.by, bench=row.bench)
            return str(row.bench)

    def key(self, bench: str) -> bytes | None:
        """Return the key by which the edge of a bench is known; None where it is known by none."""
        with self._database.reading() as connection:
            asked = select(edges.c.key).where((edges.c.bench == bench) & edges.c.revoked_at.is_(None))
            found = connection.execute(asked).scalar()
        return bytes.fromhex(found) if found else None

    def revoked(self, bench: str, by: str) -> bool:
        """Let the edge of a bench be known no more; return whether it was."""
        with self._database.writing() as connection:
            now, mine = self._database.now(connection), (edges.c.bench == bench) & edges.c.revoked_at.is_(None)
            ended = connection.execute(update(edges).where(mine).values(revoked_at=now)).rowcount
            if ended:
                write_audit(connection, now, "withdrawn", by, bench=bench)
        return bool(ended)
