"""One component type in full."""

from __future__ import annotations

from typing import Any

from pico.model.catalog import ComponentType, Footprint, Measurable, Tunable
from pico.model.record import as_json

from .style import columns, number, paint, wrap


def text(kind: ComponentType) -> str:
    """Return parameters, tunables, measurables, primitives and geometry."""
    lines = [f"{paint('bold', kind.name)}: {kind.title}", *wrap(kind.description, "")]
    lines += _table("Parameters", [[n, _value(p.value, p.unit), p.description] for n, p in kind.parameters.items()])
    near = kind.pose.tolerance
    pose = ["pose", f"within {number(near.position)} mm, {number(near.yaw)}°", f"moved by {kind.pose.mover}"]
    lines += _table("Tunables", [pose, *([n, _domain(t), _about(t)] for n, t in kind.tunables.items())])
    lines += _table(
        "Measurables", [[n, f"{m.datatype} {m.unit}".strip(), _made(m)] for n, m in kind.measurables.items()]
    )
    g = kind.geometry
    body = f"{_outline(g.footprint)}, {number(g.height)} mm high, {number(g.mass, 3)} kg"
    grasp = (
        f"held {number(g.grasp.height)} mm above the table, {number(g.grasp.width)} mm wide"
        if g.grasp
        else "not held by an arm"
    )
    lines += _table("Geometry", [["footprint", body], ["grasp", grasp], ["seating", kind.seating]])
    return "\n".join([*lines, "", f"Primitives: {', '.join(kind.primitives)}"])


def _table(title: str, rows: list[list[str]]) -> list[str]:
    return ["", paint("dim", f"{title}:"), *columns(rows, indent="  ")] if rows else []


def _value(value: Any, unit: str) -> str:
    shown = number(value, 6) if isinstance(value, int | float) and not isinstance(value, bool) else value
    return f"{shown} {unit}".strip()


def _domain(tunable: Tunable) -> str:
    if tunable.datatype == "choice":
        return " | ".join(tunable.choices or ())
    if tunable.datatype == "bool":
        return "true | false"
    if tunable.range is None:
        return f"number {tunable.unit}".strip()
    return f"{number(tunable.range[0], 6)} to {number(tunable.range[1], 6)} {tunable.unit}".strip()


def _about(tunable: Tunable) -> str:
    tolerance = f"within {number(tunable.tolerance, 4)} {tunable.unit}" if tunable.tolerance else ""
    period = f"repeats every {number(tunable.period)} {tunable.unit}" if tunable.period else ""
    return ", ".join(x for x in (tunable.mover, tolerance, period, tunable.description) if x)


def _outline(footprint: Footprint) -> str:
    if footprint.box:
        return f"{number(footprint.box[0])} x {number(footprint.box[1])} mm"
    if footprint.disc:
        return f"disc of {number(2 * footprint.disc)} mm"
    return f"polygon of {len(footprint.vertices)} corners"


def data(kind: ComponentType) -> dict[str, Any]:
    """Return schema `pico.component-type/v1` with the type under `type`."""
    return {"schema": "pico.component-type/v1", "type": as_json(kind)}


def _made(measurable: Measurable) -> str:
    """Return what a measurable is, and what computes it."""
    kernel = f"`{measurable.kernel}`" if measurable.kernel else ""
    return ": ".join(part for part in (measurable.description, kernel) if part)
