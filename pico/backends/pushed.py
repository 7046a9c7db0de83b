"""What an operation moved besides its own component: neighbors that a part knocked over or shoved as it fell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pico.backends.attempt import Failed
from pico.model.diff import deviation
from pico.model.observation import Observation, ObservedComponent
from pico.model.record import as_json
from pico.model.setup import Setup

PUSHED = "pushed"
"""The key of `OperationResult.data` under which these are."""


def pushed(setup: Setup, before: Observation, after: Observation, own: str) -> dict[str, ObservedComponent]:
    """Return the components beside `own` that stood before and now lie, or stand beyond tolerance from there."""
    found = {}
    for name, was in before.components.items():
        now = after.components.get(name)
        if name == own or now is None or was.pose is None or now.pose is None:
            continue
        if was.presence != "seen" or now.presence not in ("seen", "toppled"):
            continue
        if now.presence == "toppled" or deviation(setup, name, now.pose, None, was.pose) == "off":
            found[name] = now
    return found


def with_pushed(failure: Failed, before: Observation, parts: Mapping[str, ObservedComponent]) -> Failed:
    """Return the failure of an operation that says which other components it moved, and keeps where they are."""
    if not parts:
        return failure
    data: dict[str, Any] = {PUSHED: {name: as_json(part) for name, part in sorted(parts.items())}}
    words = ", ".join(_words(name, part, before.components[name]) for name, part in sorted(parts.items()))
    said = failure.diagnostic
    text = f"{said.summary}; it moved {words}"
    return Failed(replace(said, summary=text), failure.outcome, {**failure.data, **data})


def _words(name: str, now: ObservedComponent, before: ObservedComponent) -> str:
    if now.presence == "toppled":
        return f"{name}, which lies now"
    assert now.pose is not None and before.pose is not None  # `pushed` has no others
    return f"{name} by {now.pose.distance(before.pose):.1f} mm"
