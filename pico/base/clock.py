"""The clock on the wall: the only module that asks for the date, reads a time from text, or writes one as text.

Times in documents are ISO 8601 in UTC (`2026-11-20T08:00:00Z`). They are for people and for limits such as the end of
an arming; what is measured within one process is measured by `time.monotonic`.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime


def now() -> str:
    """Return the time as ISO 8601, UTC, to the second."""
    return as_text(datetime.now(UTC))


def now_ms() -> str:
    """Return the time as ISO 8601, UTC, to the millisecond."""
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def here() -> datetime:
    """Return the time in the time zone of this machine."""
    return datetime.now(UTC).astimezone()


def stamp() -> str:
    """Return the time as names of files and runs carry it: `20261120T080000Z`."""
    return f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}"


def today() -> str:
    """Return the day in UTC: `2026-11-20`."""
    return now()[:10]


def parse(text: str) -> datetime:
    """Return a time written in ISO 8601; one that names no time zone stays without one. Raises ValueError."""
    return datetime.fromisoformat(text)


def parse_utc(text: str) -> datetime:
    """Return a time or a day written in ISO 8601, in UTC if it names no time zone. Raises ValueError."""
    found = parse(text)
    return found if found.tzinfo else found.replace(tzinfo=UTC)


def parse_zoned(text: str) -> datetime:
    """Return a time written in ISO 8601; raises ValueError if it names no time zone."""
    found = parse(text)
    if found.tzinfo is None:
        raise ValueError(f"`{text[:40]}` names no time zone")
    return found


def parse_time_of_day(text: str) -> tuple[int, int]:
    """Return hour and minute of a time of day such as `22:00`; raises ValueError."""
    found = datetime.strptime(text, "%H:%M")
    return found.hour, found.minute


def as_text(moment: datetime) -> str:
    """Return a moment as ISO 8601, UTC, to the second."""
    return moment.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def from_epoch(seconds: float) -> datetime:
    """Return the moment, in UTC, that is so many seconds after the beginning of 1970."""
    return datetime.fromtimestamp(seconds, UTC)


def epoch(text: str) -> float:
    """Return a time written in ISO 8601 as seconds since the beginning of 1970; raises ValueError."""
    return parse(text).timestamp()


Waits = Sequence[tuple[str, float]]
"""When `pico sim wait` let time pass on a simulated bench (ISO 8601), and how long [s]."""


def seconds_on_bench(earlier: str, later: str, waits: Waits | None = None) -> float:
    """Return the seconds from one time to a later one as the clock of a bench counts them: with those that
    `pico sim wait` let pass in between (`waits`). What is written to the second and lies in the second of a wait counts
    as before it. Times in ISO 8601, in UTC if they name no time zone. Raises ValueError."""
    begin, end = parse_utc(earlier), parse_utc(later)
    told = [(parse_utc(at), seconds) for at, seconds in waits or ()]
    passed = sum(seconds for at, seconds in told if begin < at and at.replace(microsecond=0) <= end)
    return (end - begin).total_seconds() + passed


def seconds_between(earlier: str, later: str) -> float:
    """Return the seconds from one time to a later one, both in ISO 8601, in UTC if they name no time zone. Raises
    ValueError."""
    return (parse_utc(later) - parse_utc(earlier)).total_seconds()
