"""The tunables of one component as they are on the bench."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .measured import line
from .style import columns, place


def text(values: Mapping[str, Mapping[str, Any]], *, component: str) -> str:
    """Return a line a tunable; a value that was commanded and not read back says so."""
    rows = [[f"{component}.{name}", *_said(v)] for name, v in values.items()]
    return "\n".join(columns(rows))


def _said(v: Mapping[str, Any]) -> list[str]:
    if found := v.get("measurement"):
        return [line({**found, "not_assured": {}}), "peeked at: nothing of it is assured"]
    return [f"{place(v['value'])} {v.get('unit', '')}".strip(), _note(v)]


def _note(value: Mapping[str, Any]) -> str:
    return {"known": "", "commanded": "as commanded, not read back"}.get(value["status"], str(value["status"]))


def data(values: Mapping[str, Mapping[str, Any]], *, component: str) -> dict[str, Any]:
    """Return schema `pico.values/v1`: `component`, and `values` by tunable (`value`, `unit`, `status`; `peeked`
    with the `measurement`)."""
    return {"schema": "pico.values/v1", "component": component, "values": dict(values)}
