"""How a commissioning stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.commissioning import STEPS
from pico.model.record import as_json

from .style import columns, inert, paint

if TYPE_CHECKING:
    from pico.bench.commissioning.walk import Done, Standing

MARKS = {"passed": ("green", "✓"), "failed": ("red", "✗"), "begun": ("yellow", "…")}


def line(done: Done) -> str:
    """Return a line for a step that was done now."""
    return f"{paint(*MARKS[done.result.outcome])} {done.step}: {inert(done.result.told)}"


def text(standing: Standing, *, after: bool = False) -> str:
    """Return a line a step, unless they were shown as they were done (`after`), and whether the report counts."""
    report = standing.report
    rows = []
    for step in STEPS:
        found = report.steps.get(step) if report else None
        mark = paint(*MARKS[found.outcome]) if found else " "
        told = [found.at[:10], found.by, inert(found.told)] if found else ["", "", "not done"]
        rows.append([mark, step, *told])
    return "\n".join([*([] if after else columns(rows)), _verdict(standing)])


def _verdict(standing: Standing) -> str:
    if not standing.why:
        if standing.bench == "emulated":
            return f"The emulated bench is commissioned until {standing.until}; that says nothing of a real one."
        return f"This bench is commissioned until {standing.until}. Commit {standing.file} with the lab."
    refused = "no laser above class 2 is armed" if standing.bench == "hardware" else "that is of the emulated bench"
    return "\n".join([f"Not commissioned ({refused}):", *(f"  {inert(why)}" for why in standing.why)])


def data(standing: Standing, *, after: bool = False) -> dict[str, Any]:
    """Return schema `pico.commission/v1`: `bench`, `file`, the `report` as the file has it, `why` that does not count
    (empty where it does), and `until` when it does by its age."""
    return {"schema": "pico.commission/v1", **as_json(standing)}
