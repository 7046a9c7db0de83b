"""What the coordinator tells an edge that asks, and what it learns by that."""

from __future__ import annotations

from typing import Any

from pico.control.gate import Command, Record
from pico.control.leases import HEARTBEAT, TTL, Grant, Lease, left
from pico.server.relay.hub import EdgeLine
from pico.server.store.books import Books
from pico.server.store.commands import CommandRows
from pico.server.store.ordered import write_event


class Polled:
    """Answers the questions of the edge on one line."""

    def __init__(self, books: Books, rows: CommandRows, line: EdgeLine) -> None:
        self._books, self._rows, self._line, self._met = books, rows, line, False

    async def answer(self, poll: dict[str, Any]) -> dict[str, Any]:
        """Return which token counts, and how long still; once the edge has fenced for a lease, also which commands of
        earlier ones have no end in the books, whose records it then says with its next question. What an edge says of
        itself is of when it asked."""
        books, line, bench = self._books, self._line, self._line.bench
        line.fenced, line.moving = int(poll["fenced"]), str(poll["moving"] or "")
        line.hindered = ", ".join(str(one)[:300] for one in list(poll.get("hindered", ()))[:3])
        if poll.get("left"):
            await books.do(self._left, str(poll["left"]["at"])[:40], list(poll["left"]["wrong"])[:20])
            books.announce()
        if "records" in poll:
            await books.do(
                self._rows.reconciled, bench, line.fenced, [record_from_json(one) for one in poll["records"]]
            )
        before, now, _ = await books.look(books.leases.shown, bench)
        row, asked = before, tuple[str, ...]()
        if not self._met or _tells(row, line.fenced):
            row, self._met = (await books.turn(books.leases.heard, bench, line.fenced)).row, True
            asked = await books.look(self._rows.open, bench, line.fenced)
        grant = row.grant
        if grant is not None and grant.token == line.fenced:
            if line.moving and _goes_on(grant, line.moving):
                if grant.expires - now < TTL - HEARTBEAT:
                    row = (await books.turn(books.leases.renewed, bench, grant.holder.session, grant.token)).row
            elif (
                grant.job
                and not poll["busy"]
                and int(poll["taken"]) >= await books.look(self._rows.last, bench, grant.token)
            ):  # its run is over
                row = (await books.turn(books.leases.released, bench, grant.holder.session, grant.token)).row
        if row is not before:  # writing that took its time
            _, now, _ = await books.look(books.leases.shown, bench)
        token, seconds = left(row, now)
        lease = {"lease": {"asked": poll["asked"], "token": token, "left": seconds}}
        return {**lease, "open": list(asked)} if asked else lease

    def _left(self, at: str, wrong: list[Any]) -> None:
        """Write how an edge left its bench when the lease of that was over."""
        database = self._books.database
        with database.writing() as connection:
            said = [str(one["summary"])[:300] for one in wrong]
            write_event(connection, database.now(connection), self._line.bench, "left", {"at": at, "wrong": said})


def _goes_on(grant: Grant, run: str) -> bool:
    """Return whether a lease is renewed for a run, whoever listens: it was asked for that, or its session took it."""
    return grant.job == run or "~" not in grant.holder.session


def _tells(row: Lease, fenced: int) -> bool:
    """Return whether that an edge has fenced for a token is news."""
    grant = row.grant
    if grant is None:
        return fenced > row.token
    return grant.token < fenced or (grant.token == fenced and not grant.fenced)


def record_from_json(data: dict[str, Any]) -> Record:
    """Return what an edge knows of a command, as it said; raises what Python does for what is none."""
    command = data["command"]
    known = Command(int(command["token"]), int(command["seq"]), str(command["key"]), str(command["digest"]))
    if data["phase"] not in ("started", "done", "failed", "unknown"):
        raise ValueError(f"no phase of a command: {data['phase']!r}")
    return Record(known, data["phase"], str(data["result"]))
