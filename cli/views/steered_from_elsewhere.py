"""A teleoperation that is begun here, and steered by who says frames to its run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json
from pico.teleop.steps import ladder

if TYPE_CHECKING:
    from pico.bench.teleoperation import Teleoperation


def text(jog: Teleoperation) -> str:
    """Return which run it is, and until when somebody is to be heard of."""
    name = jog.operation.component
    return f"{name} is steered in run {jog.run.id}: it ends where nobody says a frame to it (call `jog`) for 5 s."


def data(jog: Teleoperation) -> dict[str, Any]:
    """Return schema `pico.steered/v1`: the `run`, its `operation` and `component`, the `robot` that holds it, and the
    `tunables`: of each `unit`, `range`, `period`, `longest` step and the `steps` to choose from."""
    return {
        "schema": "pico.steered/v1", "run": jog.run.id, "operation": jog.operation.id,
        "component": jog.operation.component, "robot": jog.operation.robot,
        "tunables": {name: as_json(one) | {"steps": ladder(one.longest)} for name, one in jog.known.items()},
    }  # fmt: skip
