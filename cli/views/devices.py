"""The instruments of a bench, and what they answered."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from . import diagnostics
from .style import columns, inert, paint

if TYPE_CHECKING:
    from pico.backends.instruments import InstrumentRow


def text(rows: Sequence[InstrumentRow], *, identify: bool = False) -> str:
    """Return a line a device; `identify`: what to write into the lab's file of each."""
    if identify:
        return "\n".join(_identity(row) for row in rows)
    asked = any(row.answer for row in rows)
    last = ["answers", "reads"] if asked else ["address", ""]
    head = [paint("dim", cell) for cell in ("device", "of", "kind", "driver", "tried", *last)]
    return "\n".join(columns([head, *(_cells(row, asked) for row in rows)]))


def _cells(row: InstrumentRow, asked: bool) -> list[str]:
    first = [row.name, row.of, row.kind, row.driver, row.maturity]
    if not asked:
        return [*first, row.address, paint("yellow", row.install)]
    who = row.answer.identity if row.answer else None
    said = inert(f"{who.model} {who.serial} {who.firmware}".strip()) if who else paint("red", "no")
    wrong = row.answer is None or bool(row.answer.diagnostics)
    return [*first, said, paint("red", "see below") if wrong else row.answer.reads if row.answer else ""]


def _identity(row: InstrumentRow) -> str:
    who = row.answer.identity if row.answer else None
    if who is None:
        return f"{row.name}: {paint('red', 'no answer')}"
    said = f'identity: {{vendor: "{who.vendor}", model: "{who.model}", serial: "{who.serial}"}}'
    return f"{row.name}: {inert(said)}"


def data(rows: Sequence[InstrumentRow], *, identify: bool = False) -> dict[str, Any]:
    """Return schema `pico.devices/v1`: `devices`, of each its row, with `answer` where it was asked."""
    found = []
    for row in rows:
        shown = {**as_json(row)}
        if row.answer:
            shown["answer"] |= diagnostics.data(row.answer.diagnostics)
        found.append(shown)
    return {"schema": "pico.devices/v1", "devices": found}
