"""The lasers of a bench: their class, whether they emit, and what lets them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.model.arming import Arming
from pico.model.record import as_json

from .style import columns, number, paint

if TYPE_CHECKING:
    from pico.bench.lasers import LaserRow

AFTER = "`pico laser disarm NAME` shuts it; `pico laser` shows what is armed."


def text(rows: Sequence[LaserRow]) -> str:
    """Return a line a laser."""
    if not rows:
        return "This bench has no laser."
    head = [paint("dim", cell) for cell in ("laser", "class", "emits", "shutter", "what lets it")]
    return "\n".join(columns([head, *map(_cells, rows)]))


def _cells(row: LaserRow) -> list[str]:
    emits = paint("red", "yes") if row.emits else "no"
    shutter = row.shutter or ("unknown" if row.gate else "none")
    where = f"{shutter} ({row.gate})" if row.gate and row.gate != row.laser else shutter
    off = ", off" if row.emission is False else ""
    return [row.laser, f"{row.laser_class} ({number(row.power)} mW)", emits, f"{where}{off}", _lets(row)]


def _lets(row: LaserRow) -> str:
    armed = _armed(row.arming, begun=row.begun) if row.arming else ""
    if row.broken:
        armed = paint("red", f"its arming can't be read, and does not count: {row.broken}")
    waived = {"low": "nobody has to arm class 1 and 2", "waived": "the lab waives it: nothing is emitted here"}
    said = waived.get(row.lets, "" if armed else f"nothing: `pico laser arm {row.laser}`")
    said += "; `pico apply` lets it out" if row.lets in waived and not row.emits else ""
    return "; ".join(part for part in (said, armed) if part)


def _armed(given: Arming, *, begun: bool) -> str:
    when = f"until {local(given.ends)}" if begun else f"from {local(given.begins)} to {local(given.ends)}"
    how = ", unattended" if given.unattended else ""
    return f"armed by {given.by} ({given.role}) {when}, up to class {given.laser_class}{how}"


def sentence(given: Arming) -> str:
    """Return what an arming says, as a question or an answer begins."""
    begins = f" from {local(given.begins)}" if given.unattended else ""
    who = f"as {given.by} ({given.role})"
    return f"Arm {given.laser}{begins} until {local(given.ends)}, up to class {given.laser_class}, {who}"


def local(text: str) -> str:
    """Return a time as clocks here show it: the day where that is not today."""
    at = clock.parse(text).astimezone()
    today = at.date() == clock.here().date()
    return f"{at:%H:%M}" if today else f"{at:%Y-%m-%d %H:%M}"


def next_time(text: str) -> datetime:
    """Return the next time that clocks here show `text` (22:00); raises ValueError for what is no such time."""
    now = clock.here()
    hour, minute = clock.parse_time_of_day(text)
    at = now.replace(hour=hour, minute=minute, second=0, microsecond=0)
    return at if at > now else at + timedelta(days=1)


def data(rows: Sequence[LaserRow]) -> dict[str, Any]:
    """Return schema `pico.lasers/v1`: of each of `lasers` its class, `power` [mW], `emits`, `emission`, `gate`,
    `shutter`, what `lets` it, its `arming`, and what is wrong with that (`broken`)."""
    return {"schema": "pico.lasers/v1", "lasers": [as_json(row) for row in rows]}
