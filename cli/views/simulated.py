"""What was done to the simulated world."""

from __future__ import annotations

from typing import Any

from pico.model.pose import Pose
from pico.model.record import as_json


def text(done: str, **_: Any) -> str:
    """Return one line."""
    return f"Simulated bench: {done}."


def data(done: str, pose: Pose | None = None) -> dict[str, Any]:
    """Return schema `pico.sim/v1`: `done` in words, and the `pose` where a component was moved."""
    return {"schema": "pico.sim/v1", "done": done, "pose": as_json(pose)}
