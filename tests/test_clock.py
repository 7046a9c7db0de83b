"""One module asks for the date, reads times from text and writes them."""

from __future__ import annotations

import ast
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest

from pico.base import clock

ROOT = Path(__file__).resolve().parent.parent
OF_THE_CLOCK = {"now", "utcnow", "today", "fromisoformat", "fromtimestamp", "utcfromtimestamp", "strptime", "strftime"}
"""What `datetime` and `date` are asked for by the clock alone. `isoformat` of a moment that is at hand, `time.time` (an
age beside the time of a file, or seconds that a program reads) and `time.monotonic` are no such question."""


def asked_elsewhere(tree: ast.Module) -> list[int]:
    """Return the lines that ask a date, or a module of times, what only the clock is to answer."""
    found = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.Attribute) or node.attr not in OF_THE_CLOCK:
            continue
        named = ast.unparse(node.value)
        if node.attr in ("fromisoformat", "strptime", "strftime") or named.split(".")[-1] in ("datetime", "date"):
            found.append(node.lineno)
    return found


def test_only_the_clock_asks_for_the_date_and_reads_and_writes_times() -> None:
    elsewhere = [
        f"{path.relative_to(ROOT)}:{line}: use pico.base.clock"
        for top in ("pico", "cli")
        for path in sorted((ROOT / top).rglob("*.py"))
        if path != ROOT / "pico" / "base" / "clock.py"
        for line in asked_elsewhere(ast.parse(path.read_text()))
    ]
    assert not elsewhere, "\n".join(elsewhere)


@pytest.mark.parametrize(
    "line", ["datetime.now(UTC)", "datetime.datetime.fromisoformat(a)", "date.today()", "a.strftime('%Y')"]
)
def test_what_asks_for_the_date_is_noticed(line: str) -> None:
    assert asked_elsewhere(ast.parse(line)) == [1]


def test_what_the_clock_writes_it_reads_again() -> None:
    for text in (clock.now(), clock.now_ms()):
        moment = clock.parse_zoned(text)
        assert abs((datetime.now(UTC) - moment).total_seconds()) < 10 and moment.utcoffset() == timedelta(0)
    assert len(clock.now()) == 20 and len(clock.now_ms()) == 24 and clock.now().startswith(clock.today())
    assert clock.as_text(clock.parse("2026-11-20T10:00:00+02:00")) == "2026-11-20T08:00:00Z"
    assert clock.as_text(clock.from_epoch(clock.epoch("2026-11-20T08:00:00Z"))) == "2026-11-20T08:00:00Z"


def test_the_seconds_between_two_times_count_zones_and_sign() -> None:
    assert clock.seconds_between("2026-11-20T08:00:00Z", "2026-11-20T10:00:01.500+02:00") == 1.5
    assert clock.seconds_between("2026-11-21", "2026-11-20T00:00:00Z") == -86400
    assert clock.parse("2026-11-20T10:00:00+02:00").tzinfo == timezone(timedelta(hours=2))
    with pytest.raises(ValueError, match="no time zone"):
        clock.parse_zoned("2026-11-20T08:00:00")
    with pytest.raises(ValueError):
        clock.seconds_between("yesterday", "2026-11-20")
