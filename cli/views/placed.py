"""What it came to that the arm put a part down by the light."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.bench.placing import MOST, NEAR
from pico.model.record import as_json

from .style import columns, count, paint, wrap

if TYPE_CHECKING:
    from pico.bench.placing import Placed, Try


def line(one: Try) -> str:
    """Return one try in a line."""
    off = paint("yellow", one.why) if one.off is None else f"{one.off:+.3f} mm off by the light"
    return f"  {'as it stood' if one.sent is None else f'put down at {one.sent:+.3f} mm'}: {off}"


def ahead(component: str, detector: str) -> str:
    """Return what the arm is about to do."""
    asked = (
        f"center {component} {detector}: the light is measured; while it is more than {NEAR:g} mm off by it, the arm"
    )
    tries = f"puts {component} down anew, {MOST} times at most, the laser shut meanwhile."
    return "\n".join(wrap(f"{asked} {tries}", "  "))


def text(found: Placed) -> str:
    """Return the outcome in a line, the tries, and how to go back."""
    times, said = len(found.tries) - 1, paint("green", "met") if found.met else paint("yellow", "not met")
    lines = wrap(f"center {found.component} {found.detector}: {said}, put down {count(times, 'time')}", "  ")
    lines += wrap(f"Stopped: {found.why}.", "  ") if not found.met else []
    rows = [[paint("dim", cell) for cell in ("sent to", "off by the light", "run")]]
    seen = [_mm(t.off) or ("not measured" if t.why == found.why else t.why) for t in found.tries]
    rows += [[_mm(t.sent) or "as it stood", off, t.run] for t, off in zip(found.tries, seen, strict=True)]
    lines += [f"  {row}" for row in columns(rows)]
    if not times:
        return "\n".join(lines)
    pose = found.first
    back = f"`pico move {found.component} x={pose.x:.3f} y={pose.y:.3f} yaw={pose.yaw:.2f}`"
    return "\n".join([*lines, *(wrap(f"Each try is a run of its own; {back} goes back to where it stood.", "  "))])


def _mm(value: float | None) -> str:
    return "" if value is None else f"{value:+.3f} mm"


def data(found: Placed) -> dict[str, Any]:
    """Return schema `pico.placed/v1`: `component`, `detector`, `met`, `why`, `near`, `slope`, `first`, and `tries`:
    `sent`, `off` [mm], `why`, `run`."""
    return {"schema": "pico.placed/v1", **as_json(found)}
