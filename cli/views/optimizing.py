"""An optimization under way: one line that is overwritten, events as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json
from pico.model.trace.event import Event

from .style import number, shorten, wide

if TYPE_CHECKING:
    from pico.bench.goals import Chosen
    from pico.model.setup import Setup


def line(event: Event, chosen: Chosen, setup: Setup) -> str:
    """Return the line after a measurement; empty for other events."""
    if event.kind != "operation_progress" or "measured" not in event.data:
        return ""
    values = {n: v for n, v in event.data["values"].items() if not n.endswith("_sigma")}
    seen = ", ".join(f"{n} {number(v, 4)}" for n, v in values.items()) or event.data.get("unknown", "dark")
    point = ", ".join(f"{n} {number(v, 4)}" for n, v in event.data["point"].items())
    most = sum(one.goal.budget.measurements for one in (*chosen.first, chosen.one))
    name = event.data.get("goal", chosen.name)
    return shorten(f"{name}  {event.data['measured']} of {most}  {seen}  ({point})", wide())


def data(event: Event) -> dict[str, Any]:
    """Return an event, schema `pico.event/v1`."""
    found: dict[str, Any] = as_json(event)
    return found
