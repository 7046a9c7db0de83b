"""Principals, what they may, and the tokens that let them in."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, Row, bindparam, delete, insert, select, update

from pico.diagnostics import ExitCode, PicoError, error
from pico.server.access.principal import Principal, Right, require_name, unauthenticated
from pico.server.access.secret import CODE_LASTS, LONGEST, SAFELY, SESSION_LASTS, fingerprint, new_secret
from pico.server.store.database import Database
from pico.server.store.ordered import write_audit
from pico.server.store.tables import principals, rights, sessions, tokens

LET_IN = ("token", "desk", "look")
"""The kinds of tokens that let somebody in."""


@dataclass(frozen=True, slots=True)
class Issued:
    """A token or a code that was made; `secret` is shown once, and kept nowhere."""

    id: str
    secret: str
    expires_at: float


_LETS_IN = tokens.c.kind.in_(LET_IN)
# what is asked for each second by everything that goes on is put together once
_TOKEN = select(tokens).where(tokens.c.hash == bindparam("hash"), _LETS_IN)
_SEATED = select(tokens).where(tokens.c.id == bindparam("id"), _LETS_IN)
_SESSION = select(sessions).where(sessions.c.hash == bindparam("hash"))
_RIGHTS = select(rights.c.lab, rights.c.role).where(rights.c.principal == bindparam("name"))
_DISABLED = select(principals.c.disabled).where(principals.c.name == bindparam("name"))


class People:
    """Who may do what."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def entered(self) -> bool:
        """Return whether anybody has ever had a token."""
        with self._database.reading() as connection:
            return connection.execute(select(tokens.c.id).where(tokens.c.kind == "token").limit(1)).first() is not None

    def listed(self) -> tuple[dict[str, Any], ...]:
        """Return the principals with their rights."""
        with self._database.reading() as connection:
            rows = connection.execute(select(principals).order_by(principals.c.name)).all()
            return tuple(
                {"name": r.name, "disabled": r.disabled, "rights": sorted(map(str, _rights(connection, r.name)))}
                for r in rows
            )

    def settled(self, name: str, having: Iterable[Right], *, by: str, disabled: bool = False) -> None:
        """Make a principal, or change what it may; one that is disabled is let in no more. Raises PicoError for a name
        that is none."""
        require_name(name, "a principal")
        having = frozenset(having)
        with self._database.writing() as connection:
            now = self._database.now(connection)
            if (
                connection.execute(select(principals).where(principals.c.name == name).with_for_update()).first()
                is None
            ):
                connection.execute(insert(principals).values(name=name, created_at=now, disabled=disabled))
            else:
                connection.execute(update(principals).where(principals.c.name == name).values(disabled=disabled))
            connection.execute(delete(rights).where(rights.c.principal == name))
            for right in having:
                connection.execute(insert(rights).values(principal=name, lab=right.lab, role=right.role))
            if disabled:
                _fade(connection, now, tokens.c.principal == name)
            text = "disabled" if disabled else ", ".join(sorted(map(str, having)))
            write_audit(connection, now, "principal", by, of=name, why=text)

    def issued(
        self, name: str, lasts: float, *, by: str, kind: str = "token", label: str = "",
        scope: Iterable[Right] | None = None, parent: str | None = None,
    ) -> Issued:  # fmt: skip
        """Make a token (or a code) of a principal that lasts so long [s], with the token `parent`: one of the same
        principal ends with that, and does not outlast it unless that is an admin's. Raises PicoError where there is no
        such principal, or the parent is revoked."""
        with self._database.writing() as connection:
            now = self._database.now(connection)
            if connection.execute(select(principals).where(principals.c.name == name)).first() is None:
                raise PicoError(error("unknown-principal", f"there is nobody called {name} here"))
            return _issue(connection, now, name, lasts, by=by, kind=kind, label=label, scope=scope, parent=parent)

    def exchanged(self, code: str, label: str, lasts: float) -> Issued | None:
        """Exchange a code for a token, once; None for a code that is none, or none any more."""
        with self._database.writing() as connection:
            now = self._database.now(connection)
            mine = (tokens.c.hash == fingerprint(code)) & (tokens.c.kind == "code")
            row = connection.execute(select(tokens).where(mine).with_for_update()).first()
            if row is None or row.ended_at is not None or row.expires_at <= now or _disabled(connection, row.principal):
                return None
            connection.execute(update(tokens).where(tokens.c.id == row.id).values(ended_at=now))
            scope = None if row.scope is None else [Right(*pair) for pair in json.loads(row.scope)]
            return _issue(
                connection, now, row.principal, lasts, by=row.principal, label=label, scope=scope, parent=row.parent
            )

    def revoked(self, token: str, *, by: str, of: str | None = None) -> bool:
        """End a token and those that were made with it, of the principal `of` alone where one is named; return whether
        there was one that lasted. The token of a run at a desk, made with it, lasts until that has ended safely."""
        with self._database.writing() as connection:
            now = self._database.now(connection)
            mine = (tokens.c.id == token) & tokens.c.ended_at.is_(None)
            row = connection.execute(select(tokens).where(mine).with_for_update()).first()
            if row is None or (of is not None and row.principal != of):
                return False
            connection.execute(update(tokens).where(tokens.c.id == token).values(ended_at=now))
            write_audit(connection, now, "revoke", by, of=f"{row.principal}/{token}")
            for below in _below(connection, token):
                if below.kind == "desk":
                    _fade(connection, now, tokens.c.id == below.id)
                elif below.ended_at is None:
                    connection.execute(update(tokens).where(tokens.c.id == below.id).values(ended_at=now))
                    write_audit(connection, now, "revoke", by, of=f"{below.principal}/{below.id}", why=f"with {token}")
            return True

    def last(self, *ids: str) -> bool:
        """Return whether tokens let somebody in, all of them."""
        with self._database.reading() as connection:
            now = self._database.now(connection)
            return all(_known(connection, now, tokens.c.id == one) is not None for one in ids)

    def tokens(self, of: str | None = None) -> tuple[dict[str, Any], ...]:
        """Return the tokens that last, of one principal or of all, without what is secret in them."""
        with self._database.reading() as connection:
            now = self._database.now(connection)
            asked = select(tokens).where(tokens.c.ended_at.is_(None), tokens.c.expires_at > now)
            if of is not None:
                asked = asked.where(tokens.c.principal == of)
            return tuple(_shown(row) for row in connection.execute(asked.order_by(tokens.c.created_at)).mappings())

    def known(self, secret: str) -> Principal | None:
        """Return whom a token lets in; None for one that is none, or none any more."""
        with self._database.reading() as connection:
            row = connection.execute(_TOKEN, {"hash": fingerprint(secret)}).first()
            return _let_in(connection, self._database.now(connection), row)

    # browsers

    def opened(self, secret: str) -> Issued | None:
        """Make a session of a token, which ends with it; None for what is no token, or none any more."""
        with self._database.writing() as connection:
            now = self._database.now(connection)
            whose = _known(connection, now, tokens.c.hash == fingerprint(secret))
            if whose is None:
                return None
            made = Issued(whose.token, new_secret("session"), min(now + SESSION_LASTS, whose.expires_at))
            values = {"token": whose.token, "created_at": now, "expires_at": made.expires_at}
            connection.execute(insert(sessions).values(hash=fingerprint(made.secret), **values))
            return made

    def seated(self, secret: str) -> Principal | None:
        """Return whom a session lets in; None for one that is none, or none any more."""
        with self._database.reading() as connection:
            now = self._database.now(connection)
            row = connection.execute(_SESSION, {"hash": fingerprint(secret)}).first()
            if row is None or row.ended_at is not None or row.expires_at <= now:
                return None
            return _let_in(connection, now, connection.execute(_SEATED, {"id": row.token}).first())

    def closed(self, secret: str) -> bool:
        """End a session; return whether there was one that lasted."""
        with self._database.writing() as connection:
            mine = (sessions.c.hash == fingerprint(secret)) & sessions.c.ended_at.is_(None)
            ended = connection.execute(update(sessions).where(mine).values(ended_at=self._database.now(connection)))
            return bool(ended.rowcount)


def _issue(
    connection: Connection, now: float, name: str, lasts: float, *, by: str, kind: str = "token", label: str = "",
    scope: Iterable[Right] | None = None, parent: str | None = None,
) -> Issued:  # fmt: skip
    longest = CODE_LASTS if kind == "code" else LONGEST
    if not 0 < lasts <= longest:
        text = f"a {kind} lasts {longest / 86400:g} days at most"
        raise PicoError(error("usage", text, hint="ask for a shorter time; it can be made anew"))
    secret = new_secret(kind)
    held = None if scope is None else json.dumps(sorted((right.lab, right.role) for right in scope))
    until = now + lasts
    if parent is not None:
        above = connection.execute(select(tokens).where(tokens.c.id == parent).with_for_update()).one()
        until = min(until, _longest_below(connection, above, name, kind))
        parent = parent if above.principal == name else None
    made = Issued(fingerprint(secret).hex()[:12], secret, until)
    values = {"principal": name, "kind": kind, "label": label[:200], "scope": held, "created_at": now, "parent": parent}
    row = {"id": made.id, "hash": fingerprint(secret), "expires_at": made.expires_at, **values}
    connection.execute(insert(tokens).values(**row))
    write_audit(connection, now, kind, by, of=f"{name}/{made.id}", why=label[:200])
    return made


def _longest_below(connection: Connection, above: Any, name: str, kind: str) -> float:
    """Return until when what is made with a token may last; raises PicoError for one that makes none."""
    if above.ended_at is not None:
        raise unauthenticated()
    if above.kind != "token":
        raise PicoError(error("forbidden", "the token of a command at a desk makes no other"), ExitCode.DENIED)
    if kind == "desk":
        return float(above.expires_at) + SAFELY
    if kind != "look" and (above.principal != name or Right("*", "admin") in _carried(connection, above)):
        return math.inf
    return float(above.expires_at)


def _below(connection: Connection, token: str) -> Iterator[Row[Any]]:
    """Yield what was made with a token, what was made with that, and so on."""
    found = connection.execute(select(tokens).where(tokens.c.parent == token).with_for_update()).all()
    for row in found:
        yield row
        yield from _below(connection, row.id)


def _fade(connection: Connection, now: float, which: Any) -> None:
    """Let tokens of runs at desks last until what moves has come to its safe end, and no longer."""
    late = which & (tokens.c.kind == "desk") & (tokens.c.expires_at > now + SAFELY)
    connection.execute(update(tokens).where(late).values(expires_at=now + SAFELY))


def _known(connection: Connection, now: float, which: Any) -> Principal | None:
    return _let_in(connection, now, connection.execute(select(tokens).where(which, _LETS_IN)).first())


def _let_in(connection: Connection, now: float, row: Any) -> Principal | None:
    if row is None or row.ended_at is not None or row.expires_at <= now:
        return None
    if row.kind != "desk" and _disabled(connection, row.principal):
        return None
    return Principal(row.principal, _carried(connection, row), row.id, row.expires_at)


def _carried(connection: Connection, row: Any) -> frozenset[Right]:
    """Return the rights that a token carries."""
    having = _rights(connection, row.principal)
    return having if row.scope is None else having & {Right(*pair) for pair in json.loads(row.scope)}


def _rights(connection: Connection, name: str) -> frozenset[Right]:
    found = connection.execute(_RIGHTS, {"name": name})
    return frozenset(Right(row.lab, row.role) for row in found)


def _disabled(connection: Connection, name: str) -> bool:
    return bool(connection.execute(_DISABLED, {"name": name}).scalar())


def _shown(row: Mapping[Any, Any]) -> dict[str, Any]:
    scope = None if row["scope"] is None else sorted(str(Right(*pair)) for pair in json.loads(row["scope"]))
    words = ("id", "principal", "kind", "label", "created_at", "expires_at")
    return {word: row[word] for word in words} | {"scope": scope}
