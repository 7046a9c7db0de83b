"""Where beams run in a picture: the axis of each source among what stands on the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.optics.axis import Values, Vector, beams
from pico.twin.placement import Placement

Place = Pose | Placement
_UPRIGHT = 3.0  # deg
_DOWN = 0.005  # m


def flat(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return poses seen from above."""
    return {name: at.pose if isinstance(at, Placement) else at for name, at in poses.items()}


def beam_paths(
    setup: Setup, poses: Mapping[str, Place], values: Values | None = None
) -> Sequence[tuple[str, Vector, Vector]]:
    """Return (source, start, end) [mm] of each straight piece of the beams of the lasers that shine, as far as `values`
    tell: emission not off, and their own shutter not closed."""
    known = values or {}
    axes = (axis for axis in beams(setup, standing(poses), known) if not _dark(known.get(axis.source, {})))
    return [(axis.source, leg.start, leg.end) for axis in axes for leg in axis.legs]


def _dark(laser: Mapping[str, Any]) -> bool:
    return laser.get("emission") is False or laser.get("shutter") == "closed"


def standing(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return the poses of what stands on the table; what a hand holds, or what lies on its side, does not."""
    return flat({name: at for name, at in poses.items() if isinstance(at, Pose) or _stands(at)})


def _stands(at: Placement) -> bool:
    return at.tilt < _UPRIGHT and abs(at.position[2]) < _DOWN
