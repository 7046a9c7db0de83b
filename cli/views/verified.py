"""A bench against a state and its expectations."""

from __future__ import annotations

from typing import Any

from pico.model.expectation import Verified
from pico.model.record import as_json

from .diff import lines
from .report import expectations
from .style import count


def text(found: Verified) -> str:
    """Return what differs beyond tolerance, and what became of the expectations."""
    within = len(found.changes) - len(found.off)
    if found.off:
        verb = "is" if len(found.off) == 1 else "are"
        said = [f"{count(len(found.off), 'tunable')} {verb} not as {found.goal} says:", "", *lines(found.off), ""]
    else:
        near = f", {count(within, 'tunable')} within tolerance" if within else ""
        said = [f"The bench equals {found.goal}{near}."]
    said += expectations(found.expectations) or ["Nothing more is expected: `expect:` in a LabState says what is."]
    return "\n".join(said)


def data(found: Verified) -> dict[str, Any]:
    """Return schema `pico.verified/v1`: `goal`, `changes` (`before` is live), `expectations`, `observed_at`."""
    written: dict[str, Any] = as_json(found)
    return written
