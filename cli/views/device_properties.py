"""What instruments read of their properties, beside the replies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .measured import value
from .style import columns, inert, paint

if TYPE_CHECKING:
    from pico.backends.properties import PropertyRow

_MOST = 40
"""Characters of a reply that are shown."""


def text(rows: Sequence[PropertyRow]) -> str:
    """Return a line a property: the reply, the number in the device's unit, and in the lab's."""
    if not rows:
        return "No device answered."
    head = [paint("dim", cell) for cell in ("device", "property", "reply", "is", "in the lab")]
    return "\n".join(columns([head, *(_cells(row) for row in rows)]))


def _cells(row: PropertyRow) -> list[str]:
    raw = inert(row.raw if len(row.raw) <= _MOST else row.raw[: _MOST - 1] + "…")
    if row.unknown:
        return [row.device, row.property, raw, paint("yellow", f"unknown: {row.unknown}"), inert(row.why)]
    lab = f"{row.address} {_number(row.lab_value, row.lab_unit)}" if row.address else ""
    return [row.device, row.property, raw, _number(row.value, row.unit), lab]


def _number(found: Any, unit: str) -> str:
    """Return a number with all its digits that count, as it is compared with a reply."""
    if isinstance(found, bool) or found is None or isinstance(found, str):
        return value(found) if found is not None else ""
    return f"{found:.6g} {unit}".strip()


def data(rows: Sequence[PropertyRow]) -> dict[str, Any]:
    """Return schema `pico.device-properties/v1`: `properties`, of each its row."""
    return {"schema": "pico.device-properties/v1", "properties": as_json(list(rows))}
