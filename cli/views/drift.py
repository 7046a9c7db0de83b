"""Where the bench has left the last commit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.model.diff import Change
from pico.model.record import as_json

from .diff import lines
from .style import count, listed


def text(changes: Sequence[Change], *, head: str) -> str:
    """Return what drifted beyond tolerance, and how much within it."""
    beyond = [c for c in changes if not c.tolerated]
    near = len(changes) - len(beyond)
    within = f"{count(near, 'tunable')} {'deviates' if near == 1 else 'deviate'} within tolerance." if near else ""
    if not beyond:
        return "\n".join(x for x in (f"No drift: the bench is as {head} says.", within) if x)
    title = f"{count(len(beyond), 'tunable')} of the bench {'has' if len(beyond) == 1 else 'have'} left {head}:"
    unseen = [c for c in beyond if c.tunable == "pose" and c.before is None]
    hint = f"`pico apply {head}` brings {'it' if len(beyond) == 1 else 'them'} back; `pico capture` keeps what is."
    if unseen:
        by_hand = f"What nobody sees, or not surely, only you can put right: {listed([c.component for c in unseen])}."
        hint = f"{hint}\n{by_hand}" if len(unseen) < len(beyond) else by_hand
    return "\n".join([title, "", *lines(beyond), "", *([within] if within else []), hint])


def data(changes: Sequence[Change], *, head: str) -> dict[str, Any]:
    """Return schema `pico.drift/v1`: `head` and `changes`, from committed to live turned around: `before` is live."""
    return {"schema": "pico.drift/v1", "head": head, "changes": as_json(changes)}
