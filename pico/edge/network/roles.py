"""Which role each call of `pico.edge.link.wire.CALLS` needs; a call that is not named here nobody may make."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pico.edge.link import wire

Role = Literal["viewer", "operator", "admin", "laser:enable", "lease:steal", "teleop"]

_LOOKING = (
    "describe", "holder", "faults", "unended", "lab", "armings", "unattended", "doses", "observe", "look", "peek",
    "array", "picture", "events", "live", "report", "film", "world", "world.placements", "world.true_cameras",
    "world.true_arms",
)  # fmt: skip
_MOVING = (
    "acquire", "execute", "start", "open", "finish", "cancel", "hold", "goes_on", "leave", "resolve", "disarm",
)  # fmt: skip
ANYBODY = frozenset({"halt", "stop", "end_light"})
"""Calls that need no role, only somebody who is known."""


def _role(call: str) -> Role:
    if call in _LOOKING or call.startswith("memory"):
        return "viewer"
    if call in _MOVING or call.startswith("world."):
        return "operator"
    return {"arm": "laser:enable", "jog": "teleop", "adopt": "admin"}[call]  # type: ignore[return-value]


ROLES: Mapping[str, Role | None] = {
    call: None if call in ANYBODY else _role(call) for call in wire.CALLS if call not in wire.AT_TABLE
}
"""The role that a call needs; None: any."""


def role_of(call: str, arguments: Any) -> Role | None:
    """Return the role that a call with these arguments needs, as JSON data: a job that teleoperates needs `teleop`.

    Raises KeyError for a call that there is not.
    """
    if call in ("start", "open") and _teleoperates(arguments):
        return "teleop"
    return ROLES[call]


def _teleoperates(arguments: Any) -> bool:
    try:
        operations = arguments[0]["plan"]["operations"]
        return any(operation["primitive"] == "teleoperate" for operation in operations)
    except (LookupError, TypeError):
        return False
