"""How the steps of a calibration stand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.model.calibration.steps import STEPS
from pico.model.record import as_json

if TYPE_CHECKING:
    from pico.model.calibration.steps import StepStanding


def text(rows: Sequence[StepStanding], *, bench: str, file: Path, pictures: Path) -> str:
    """Return a line for each step and subject, and what comes next."""
    lines = []
    for step, said in STEPS.items():
        own = [row for row in rows if row.step == step]
        if own:
            lines += [
                f"{step}: {said}",
                *(f"  {'✗' if row.why else '✓'} {row.subject:<12} {_said(row)}" for row in own),
            ]
    left = [step for step in STEPS if any(row.why for row in rows if row.step == step)]
    where = f"{file.parent.name}/{file.name}"
    lines.append(f"To do: `pico --bench {bench} calibrate {' '.join(left)}`" if left else
                 f"All steps are done. Commit {where} with the lab.")  # fmt: skip
    if pictures.is_dir():
        lines.append(f"Pictures of the steps: {pictures}")
    return "\n".join(lines)


def _said(row: StepStanding) -> str:
    if row.why or row.how is None:
        return row.why
    how, age = row.how, "" if row.age is None else f", {row.age:.1f} days ago"
    sigmas = ", ".join(f"{name} ±{value:.2g}" for name, value in list(how.uncertainty.items())[:3])
    left = "" if how.residual is None else f"; {how.residual:.2g} {how.unit} are left"
    held = "" if how.held_out is None else f", {how.held_out:.2g} of what was held out"
    return f"{how.evidence} by {how.by or 'nobody named'}{age}: {sigmas or 'no uncertainty'}{left}{held}"


def data(rows: Sequence[StepStanding], *, bench: str, file: Path, pictures: Path) -> dict[str, Any]:
    """Return schema `pico.calibration-steps/v1`."""
    return {
        "schema": "pico.calibration-steps/v1", "bench": bench, "file": str(file), "pictures": str(pictures),
        "steps": as_json(list(rows)),
    }  # fmt: skip
