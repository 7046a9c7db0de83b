"""Lists that only grow, each entry under the next number: the audit, whose entries hold on to one another, and what
those who watch are told."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, insert, select, update

from pico.server.store.tables import audit, events, heads

START = "0" * 64


def _next(connection: Connection, name: str) -> tuple[int, str]:
    """Return the next number of a list, and the hash of its last entry, with the list locked until the transaction
    ends."""
    found = connection.execute(
        select(heads.c.number, heads.c.hash).where(heads.c.name == name).with_for_update()
    ).first()
    if found is None:
        connection.execute(insert(heads).values(name=name, number=0, hash=START))
        return 1, START
    return found.number + 1, found.hash


def _ended(connection: Connection, name: str, number: int, digest: str) -> None:
    connection.execute(update(heads).where(heads.c.name == name).values(number=number, hash=digest))


def chained(before: str, entry: Mapping[str, Any]) -> str:
    """Return the hash of an entry that follows the one with the hash `before`."""
    text = json.dumps(entry, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(f"{before}\n{text}".encode()).hexdigest()


def write_audit(connection: Connection, at: float, deed: str, who: str, **of: Any) -> None:
    """Write who did what; `of`: `bench`, `token`, `session`, `of`, `why`."""
    number, before = _next(connection, "audit")
    entry = {"bench": "", "token": 0, "session": "", "of": "", "why": "", **of}
    entry |= {"number": number, "at": at, "deed": deed, "who": who}
    digest = chained(before, entry)
    connection.execute(insert(audit).values(**entry, hash=digest))
    _ended(connection, "audit", number, digest)


def read_audit(connection: Connection, since: int = 0, limit: int = 1000) -> Sequence[dict[str, Any]]:
    """Return entries of the audit after a number."""
    found = connection.execute(select(audit).where(audit.c.number > since).order_by(audit.c.number).limit(limit))
    return [dict(row) for row in found.mappings()]


def broken(connection: Connection) -> int | None:
    """Return the number of the first entry of the audit that was changed, or from which on some are missing; None where
    all are as they were written. Entries cut off its end are seen where head and last entry differ."""
    before, number = START, 0
    for row in connection.execute(select(audit).order_by(audit.c.number)).mappings():
        entry = {key: value for key, value in row.items() if key != "hash"}
        number += 1
        if row["number"] != number or chained(before, entry) != row["hash"]:
            return number
        before = row["hash"]
    head = connection.execute(select(heads).where(heads.c.name == "audit")).first()
    return None if head is None or (head.number, head.hash) == (number, before) else number + 1


def write_event(connection: Connection, at: float, bench: str, kind: str, data: Mapping[str, Any]) -> int:
    """Write what those who watch are told, and return its number."""
    number, before = _next(connection, "events")
    text = json.dumps(data, separators=(",", ":"))
    connection.execute(insert(events).values(number=number, at=at, bench=bench, kind=kind, data=text))
    _ended(connection, "events", number, before)
    return number


def where(connection: Connection) -> dict[str, Any]:
    """Return which events these are (`epoch`), and the `number` of the last one."""
    found = {row.name: row for row in connection.execute(select(heads))}
    epoch = found["epoch"].hash if "epoch" in found else secrets.token_hex(8)
    if "epoch" not in found:
        connection.execute(insert(heads).values(name="epoch", number=0, hash=epoch))
    return {"epoch": epoch, "number": found["events"].number if "events" in found else 0}


def read_events(connection: Connection, since: int, limit: int = 1000) -> Sequence[dict[str, Any]]:
    """Return events after a number, in order."""
    found = connection.execute(select(events).where(events.c.number > since).order_by(events.c.number).limit(limit))
    return [{**row, "data": json.loads(row["data"])} for row in found.mappings()]
