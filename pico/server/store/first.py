"""How the first admin gets in."""

from __future__ import annotations

from pico.server.access.principal import Right
from pico.server.access.secret import CODE_LASTS
from pico.server.store.people import People

ADMIN = "admin"


def first_code(people: People) -> str | None:
    """Return a code for the first admin, who is made with it; None once anybody was let in."""
    if people.entered():
        return None
    people.settled(ADMIN, [Right("*", "admin")], by=ADMIN)
    return people.issued(ADMIN, CODE_LASTS, by=ADMIN, kind="code", label="the first").secret
