"""What moves in a run or a plan, moment by moment, for who draws it."""

from __future__ import annotations

from typing import Any

from .style import columns, count, paint, seconds

ORIGINS = {
    "planned": "as the plan reckons",
    "reconstructed": "reconstructed: a run keeps no joints, so the ways of arms are found anew",
}


def text(found: dict[str, Any]) -> str:
    """Return what is done when, how much of it there is to draw, and what that rests on."""
    rows = [
        [f"{step['start']:.1f} s", seconds(step["seconds"]), step["primitive"], step["address"], step["outcome"]]
        for step in found["steps"]
    ]
    head = [paint("dim", cell) for cell in ("from", "takes", "operation", "", "")]
    drawn = f"{count(len(found['moved']), 'key')} of {seconds(found['seconds'])}, {ORIGINS[found['origin']]}"
    return "\n".join([*columns([head, *rows]), "", f"{drawn}. `--json` holds them."])


def data(found: dict[str, Any]) -> dict[str, Any]:
    """Return `pico.frames/v1`."""
    return found
