"""What a morning would read, and how long that takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import count, seconds

if TYPE_CHECKING:
    from pico.bench.mornings import Survey


def text(survey: Survey) -> str:
    """Return the quantities, with what is set for them, and the time."""
    took = seconds(sum(op.seconds for op in survey.plan.operations))
    lines = ["", f"A morning would read {count(len(survey.quantities), 'quantity', 'quantities')}, in about {took}:"]
    for one in survey.quantities:
        at = sorted({a for shot in one.shots for a in shot.at if not a.endswith(".exposure")})
        lines.append(f"  {one.name}" + (f"   sets {', '.join(at)}" if at else ""))
    reference = f"Compared with the morning of {survey.reference.at[:16]}." if survey.reference else ""
    moved = [f"Since then, {one.component} {one.text}." for one in survey.moved]
    return "\n".join([*lines, reference or "No reference yet: no morning was accepted.", *moved, *survey.chosen.lacks])


def data(survey: Survey) -> dict[str, Any]:
    """Return schema `pico.survey/v1`: `quantities` with their `shots`, `seconds`, `reference` (a time), `lacks`."""
    return {
        "schema": "pico.survey/v1", "quantities": as_json(survey.quantities),
        "seconds": sum(op.seconds for op in survey.plan.operations),
        "reference": survey.reference.at if survey.reference else None, "lacks": list(survey.chosen.lacks),
    }  # fmt: skip
