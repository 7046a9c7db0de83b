"""Where beams run in a picture: the axis of each source among what stands on the table."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import Axis, Leg, Values, beams
from pico.optics.geometry import Vector
from pico.twin.placement import Placement

Place = Pose | Placement
_UPRIGHT = 3.0  # deg
_DOWN = 0.005  # m
_BESIDE = 0.01  # mm


def flat(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return poses seen from above."""
    return {name: at.pose if isinstance(at, Placement) else at for name, at in poses.items()}


def beam_paths(
    setup: Setup, poses: Mapping[str, Place], values: Values | None = None
) -> Sequence[tuple[str, Vector, Vector]]:
    """Return (source, start, end) [mm] of each straight piece of the beams of the lasers that shine, as far as `values`
    tell: emission not off, and their own shutter not closed."""
    known = values or {}
    axes = [axis for axis in beams(setup, standing(poses), known) if not _dark(known.get(axis.source, {}))]
    return [(axis.source, *piece) for axis in axes for leg in axis.legs for piece in _pieces(axis, leg)]


def _pieces(axis: Axis, leg: Leg) -> Iterator[tuple[Vector, Vector]]:
    """Yield a leg, and what leads to it where it does not begin at the end of the last one: within a roof mirror."""
    if leg.before is not None and math.dist(axis.legs[leg.before].end, leg.start) > _BESIDE:
        yield axis.legs[leg.before].end, leg.start
    yield leg.start, leg.end


def _dark(laser: Mapping[str, Any]) -> bool:
    return laser.get("emission") is False or laser.get("shutter") == "closed"


def standing(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return the poses of what stands on the table; what a hand holds, or what lies on its side, does not."""
    return flat({name: at for name, at in poses.items() if isinstance(at, Pose) or _stands(at)})


def _stands(at: Placement) -> bool:
    return at.tilt < _UPRIGHT and abs(at.position[2]) < _DOWN
