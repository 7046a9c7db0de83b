"""Leases in the database: each change is one transaction over a bench's row, its queue, the audit and the events.

What a change does is `pico.control.leases`; here it is read, applied and written.
"""

from __future__ import annotations

from collections.abc import Callable

from sqlalchemy import Connection, bindparam, delete, insert, or_, select, update

from pico.control import leases as control
from pico.control.leases import Asker, Audit, Grant, Lease, Turn
from pico.diagnostics import PicoError, error
from pico.server.store.database import Database
from pico.server.store.ordered import write_audit, write_event
from pico.server.store.tables import audit, benches, waiting

Change = Callable[[Lease, float, bool], Turn]
"""A change of a row, at a time [s], with whether the edge has been met."""
_ROW = select(benches).where(benches.c.bench == bindparam("of"))
_LOCKED = _ROW.with_for_update()
_QUEUE = select(waiting).where(waiting.c.bench == bindparam("of")).order_by(waiting.c.number)
_QUEUED = benches.c.granted.is_(None) & benches.c.bench.in_(select(waiting.c.bench)) & benches.c.met
_DUE = (
    select(benches.c.bench).where(or_(benches.c.expires < bindparam("now"), _QUEUED)).with_for_update(skip_locked=True)
)


class Leases:
    """Who has which bench."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def forget(self) -> None:
        """Begin anew: what each edge has fenced for is to be heard again before a number is given."""
        with self._database.writing() as connection:
            connection.execute(update(benches).values(met=False))

    def enrolled(self) -> tuple[str, ...]:
        """Return the names of the benches."""
        with self._database.reading() as connection:
            return tuple(connection.execute(select(benches.c.bench).order_by(benches.c.bench)).scalars())

    def shown(self, bench: str) -> tuple[Lease, float, float]:
        """Return a bench's row, the time, and since when who has it does (both [s]); raises PicoError where there is
        no such bench."""
        with self._database.reading() as connection:
            row, _, since = _read(connection, bench)
            return row, self._database.now(connection), since

    def met(self, bench: str) -> bool:
        """Return whether the edge of a bench has said what it fenced for since the coordinator began."""
        with self._database.reading() as connection:
            return bool(connection.execute(select(benches.c.met).where(benches.c.bench == bench)).scalar())

    def turn(self, bench: str, change: Change) -> Turn:
        """Make a change, durable before it returns; raises PicoError where there is no such bench."""
        with self._database.writing() as connection:
            now = self._database.now(connection)
            before, met, _ = _read(connection, bench, locked=True)
            turn = change(before, now, met)
            _write(connection, before, turn.row, now)
            for deed in turn.audit:
                _tell(connection, deed, now)
            if not turn.audit and before.queue != turn.row.queue:
                write_event(connection, now, bench, "queue", {"waiting": [asker.who for asker in turn.row.queue]})
            return turn

    def asked(self, bench: str, asker: Asker) -> Turn:
        """Ask for a bench; see `pico.control.leases.asked`."""
        return self.turn(bench, lambda row, now, met: control.asked(row, asker, now, met))

    def renewed(self, bench: str, session: str, token: int) -> Turn:
        """Renew a lease."""
        return self.turn(bench, lambda row, now, met: control.renewed(row, session, token, now, met))

    def kept(self, bench: str, job: str) -> Turn:
        """Renew the lease of a run that goes on by itself."""
        return self.turn(bench, lambda row, now, _: control.kept(row, job, now))

    def detached(self, bench: str, session: str, token: int, job: str) -> Turn:
        """Let the coordinator renew a lease for a run."""
        return self.turn(bench, lambda row, _now, _met: control.detached(row, session, token, job))

    def released(self, bench: str, session: str, token: int) -> Turn:
        """Give a bench back, or up waiting for it."""
        return self.turn(bench, lambda row, now, met: control.released(row, session, token, now, met))

    def stolen(self, bench: str, asker: Asker, why: str) -> Turn:
        """Take a bench from whoever has it; raises ValueError without a reason."""
        return self.turn(bench, lambda row, now, met: control.stolen(row, asker, why, now, met))

    def heard(self, bench: str, fenced: int) -> Turn:
        """Hear from the edge which token it has fenced for, then give a free bench to who waits for it."""

        def change(row: Lease, now: float, _met: bool) -> Turn:
            return control.heard(row, fenced, now).then(lambda r: control.promoted(r, now, True))

        if not self.met(bench):
            with self._database.writing() as connection:
                connection.execute(update(benches).where(benches.c.bench == bench).values(met=True))
        return self.turn(bench, change)

    def taken_over(self, bench: str, token: int) -> str:
        """Return who took a lease from its holder, and the reason that they gave; empty where nobody did."""
        mine = (audit.c.bench == bench) & (audit.c.token > token) & (audit.c.deed == "stolen")
        with self._database.reading() as connection:
            found = connection.execute(select(audit).where(mine).order_by(audit.c.number).limit(1)).first()
            return f"{found.who}: {found.why}" if found else ""

    def due(self) -> tuple[str, ...]:
        """Return the benches of which a lease is over, or that are free and waited for; without those that another
        coordinator has in hand just then."""
        with self._database.reading() as connection:
            return tuple(connection.execute(_DUE, {"now": self._database.now(connection)}).scalars())

    def promoted(self, bench: str) -> Turn:
        """End what has lapsed, and give a free bench to the first who waits."""
        return self.turn(bench, control.promoted)


def _read(connection: Connection, bench: str, *, locked: bool = False) -> tuple[Lease, bool, float]:
    found = connection.execute(_LOCKED if locked else _ROW, {"of": bench}).first()
    if found is None:
        raise PicoError(error("unknown-bench", f"there is no bench {bench} here", hint="`pico bench list` names them"))
    queue = connection.execute(_QUEUE, {"of": bench})
    grant = None
    if found.granted is not None:
        grant = Grant(found.granted, Asker(found.session, found.who), found.expires, found.fenced, found.job)
    askers = tuple(Asker(row.session, row.who) for row in queue)
    return Lease(bench, found.token, grant, askers), found.met, found.since or 0.0


def _write(connection: Connection, before: Lease, after: Lease, now: float) -> None:
    if (before.token, before.grant) != (after.token, after.grant):
        _write_row(connection, before, after, now)
    for gone in set(before.queue) - set(after.queue):
        mine = (waiting.c.bench == after.bench) & (waiting.c.session == gone.session) & (waiting.c.who == gone.who)
        connection.execute(delete(waiting).where(mine))
    for asker in after.queue:
        if asker not in before.queue:
            connection.execute(insert(waiting).values(bench=after.bench, session=asker.session, who=asker.who))


def _write_row(connection: Connection, before: Lease, after: Lease, now: float) -> None:
    grant = after.grant
    row: dict[str, object] = {
        "granted": None, "session": None, "who": None, "expires": None, "since": None, "fenced": False, "job": "",
    }  # fmt: skip
    if grant is not None:
        held = {
            "granted": grant.token, "session": grant.holder.session, "who": grant.holder.who,
            "expires": grant.expires, "fenced": grant.fenced, "job": grant.job,
        }  # fmt: skip
        new = before.grant is None or before.grant.token != grant.token
        row = held | ({"since": now} if new else {})
    connection.execute(update(benches).where(benches.c.bench == after.bench).values(token=after.token, **row))


def _tell(connection: Connection, deed: Audit, now: float) -> None:
    told = {"token": deed.token, "of": deed.of, "why": deed.why}
    write_audit(connection, now, deed.deed, deed.who, bench=deed.bench, session=deed.session, **told)
    write_event(connection, now, deed.bench, "lease", {"deed": deed.deed, "who": deed.who, **told})
