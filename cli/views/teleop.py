"""A teleoperation: the line that is overwritten while it goes on, its keys, and what it came to."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .measured import value
from .style import columns, count, paint, shorten, wide, width

if TYPE_CHECKING:
    from pico.bench.teleoperation import Teleoperation
    from pico.model.measurement import Measurement
    from pico.teleop.steps import Jogged

KEYS = {
    True: "arrows x and y   PgUp PgDn yaw   + - step   ? keys   q ends: it is set down",
    False: "left right (h l) moves   Tab next   + - step   ? keys   q ends",
}
"""What keys do: with a part in hand, and for tunables."""
HELD = "hold a key to go on; let go to stop"
PEEKED = " (peeked: not assured)"
TAPPED = "this terminal reports no releases: each press, and each repeat, is one step"


def help_lines(in_hand: bool, releases: bool) -> list[str]:
    """Return what the keys do."""
    return [paint("dim", f"  {KEYS[in_hand]}"), paint("dim", f"  {HELD if releases else TAPPED}")]


def line(
    name: str, known: Mapping[str, Jogged], values: Mapping[str, float], chosen: str, steps: Mapping[str, float],
    limit: str, shown: str,
) -> str:  # fmt: skip
    """Return the line: what is steered stands where, by which step, within what; what it shows, and what stops it."""
    one = known[chosen]
    parts = [f"{n} {number(values.get(n), steps[n])} {known[n].unit}".rstrip() for n in _told(known, chosen)]
    step = f"step {steps[chosen]:g} {one.unit}".rstrip()
    bounds = f"{one.range[0]:g} to {one.range[1]:g}" if one.range else ""
    rest = [paint("yellow", limit) if limit else "", step, bounds, shown]
    if width(whole := _joined(name, parts, rest)) > wide():
        whole = _joined(name, parts, [*rest[:2], shown.removesuffix(PEEKED)])  # what is measured before all else
    return shorten(whole, wide())


def _joined(name: str, parts: list[str], rest: list[str]) -> str:
    return "  ".join([f"{name}: {', '.join(parts)}", *(f"| {text}" for text in rest if text)])


def _told(known: Mapping[str, Jogged], chosen: str) -> list[str]:
    return list(known) if len(known) <= 3 else [chosen]


def number(found: float | None, step: float) -> str:
    """Return a value with as many decimals as a step changes."""
    if found is None:
        return "?"
    return f"{found:.{max(0, -math.floor(math.log10(step)))}f}" if step > 0 else f"{found:g}"


def shown(found: Measurement | None, why: str = "") -> str:
    """Return a measurable that was peeked at: of it nothing is assured."""
    if found is None:
        return why
    if found.unknown or found.value is None:
        return f"{found.address} {found.unknown or 'unknown'} (peeked)"
    said = found.value if isinstance(found.value, Mapping) else {"": found.value}
    numbers = [f"{n} {v:.4g}".strip() if isinstance(v, int | float) else f"{n} {v}" for n, v in said.items()]
    unit = ", ".join(dict.fromkeys(found.unit.split(", "))) if isinstance(found.unit, str) else ""
    return f"{found.address} {', '.join(numbers)} {unit}".rstrip() + PEEKED


def text(jog: Teleoperation, *, code: int) -> str:
    """Return what it came to, and what to do next."""
    data, report = _data(jog), jog.report
    first, last = data.get("first") or {}, data.get("last") or {}
    rows = [[paint("dim", cell) for cell in ("", "before", "after")]]
    for name, one in jog.known.items():
        address = f"{jog.operation.component}.{name}"
        cells = [value(of[address], one.unit) if address in of else "-" for of in (first, last)]
        rows.append([address, *cells])
    steps = count(int(data.get("steps", 0)), "step")
    refused = f", {data['refused']} refused" if data.get("refused") else ""
    kept = "  Keep it: `pico capture`, then `pico commit`. Go back: `pico undo`."
    then = [kept] if data.get("steps") and not report.held else []
    return "\n".join(
        [*(f"  {row}" for row in columns(rows)), f"  {steps}{refused}; `pico runs show {report.run}`", *then]
    )


def data(jog: Teleoperation, *, code: int) -> dict[str, Any]:
    """Return schema `pico.teleoperation/v1`: `component`, `first` and `last` by address, `steps`, `refused`, `run`, its
    `outcome` and the `diagnostics` of the run."""
    found, report = _data(jog), jog.report
    return {
        "schema": "pico.teleoperation/v1", "component": jog.operation.component, "first": found.get("first") or {},
        "last": found.get("last") or {}, "steps": found.get("steps", 0), "refused": found.get("refused", 0),
        "run": report.run, "outcome": report.outcome, "diagnostics": as_json(report.diagnostics), "code": code,
    }  # fmt: skip


def _data(jog: Teleoperation) -> Mapping[str, Any]:
    """Return what the edge says of the operation; of one that failed what was heard last."""
    for event in jog.events:
        if event.kind == "operation_done" and event.operation == jog.operation.id:
            return event.data
    first, last = (
        {f"{jog.operation.component}.{name}": value for name, value in values.items()}
        for values in (jog.first, jog.values)
    )
    return {"first": first, "last": last, "steps": jog.answer.steps, "refused": jog.answer.missed}
