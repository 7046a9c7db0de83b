"""Who is connected, and whose connection makes room for others.

A connection that sends no whole request costs a descriptor for as long as it stays open. So each one has to send its
headers and its body within a time, those who have not logged in share a number of places by address, and some
descriptors are kept for who comes next: STOP gets in however many others wait.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

HEADERS = 10.0
"""Within what time the headers of a request have to be whole, TLS included [s]."""
RATE = 1 << 14
"""What a body has to come with after that time, at least [bytes/s]."""
STRANGERS = 64
"""Connections from one address that have not logged in."""
MOST = 4096
"""Connections at a time."""
RESERVE = 128
"""Descriptors that no connection may take: for files, git, STOP."""

Phase = Literal["headers", "body", "idle", "answering"]
_LEAVES: tuple[Phase, ...] = ("headers", "body", "idle", "answering")
"""Whose connection is closed first if there is no room."""


@dataclass(slots=True, eq=False)
class Visit:
    """A connection: from where, what it does, since when [s, monotonic], whether it has logged in, and how much of a
    body has come [bytes]."""

    address: str
    since: float
    phase: Phase = "headers"
    known: bool = False
    received: int = 0

    def enter(self, phase: Phase, now: float) -> None:
        """Go on with another phase; the same one is not begun anew."""
        if phase != self.phase:
            self.phase, self.since, self.received = phase, now, 0

    def late(self, now: float) -> bool:
        """Whether headers or a body should have been whole by now."""
        due = {"headers": HEADERS, "body": HEADERS + self.received / RATE}.get(self.phase)
        return due is not None and now - self.since > due


def superfluous(visits: Iterable[Visit], address: str, room: int, strangers: int = STRANGERS) -> Visit | None:
    """Return whose connection is to be closed, now that one more came from `address`: among the strangers of that
    address if they are more than `strangers`, else among all if they are more than `room`. None: there is room.

    Strangers leave first; of those who logged in, none that is being answered.
    """
    present = list(visits)
    same = [v for v in present if v.address == address and not v.known]
    if len(same) > strangers:
        return min(same, key=_turn)
    if len(present) > room:
        return min((v for v in present if not v.known or v.phase != "answering"), key=_turn, default=None)
    return None


def _turn(visit: Visit) -> tuple[bool, int, float]:
    return visit.known, _LEAVES.index(visit.phase), visit.since
