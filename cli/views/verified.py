"""A bench against a state and its expectations."""

from __future__ import annotations

from typing import Any

from pico.model.expectation import Standing, Verified
from pico.model.record import as_json

from .diff import lines
from .report import expectations
from .runs import shown
from .style import count, paint, wrap

_ON: dict[str | None, str] = {"emulated": "emulated devices, never hardware", "hardware": "hardware"}


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
    return "\n".join([*said, *(proof(found.standing, left=found.left) if found.standing else [])])


def proof(standing: Standing, *, left: bool = False) -> list[str]:
    """Return in a few lines whether a bench ever stood as a commit says: `4f2c9a1 is verified: ...`; `left`: it does
    not stand so now."""
    colors = {"verified": "green", "inherited": "yellow", "planned": "yellow", "unknown": "red"}
    then = left and standing.verdict == "verified"
    verb, since = ("was", "; the bench has left it since") if then else ("is", "")
    word = paint("yellow" if then else colors[standing.verdict], standing.verdict)
    head = f"{standing.commit[:7]} {verb} {word}: {shown(standing.why)}{since}."
    return [*wrap(head, ""), *(f"  {line}" for line in _said(standing))]


def _said(standing: Standing) -> list[str]:
    if standing.verdict in ("inherited", "planned"):
        return ["Nobody has seen this state on a bench: `pico apply` and `pico commit` prove it."]
    if standing.verdict == "unknown":
        return []
    what = (
        f"Simulated ({standing.evidence}): never hardware." if standing.simulated else f"On {_ON[standing.evidence]}."
    )
    when = f" {standing.at[:16].replace('T', ' ')} UTC" if standing.at else ""
    if standing.run is None:
        return [what]
    where = f"carried by {standing.carried[:7]}" if standing.carried else "no commit has it yet: `pico commit` takes it"
    return [what, f"The run ended{when}, {where}; `pico runs show {standing.run}`."]


def data(found: Verified) -> dict[str, Any]:
    """Return schema `pico.verified/v1`: `goal`, `changes` (`after` is live), `expectations`, `standing`."""
    written: dict[str, Any] = as_json(found)
    return written
