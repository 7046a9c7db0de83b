"""Where beams run in a picture: the axis of each source among what stands on the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.optics.axis import Vector, beams
from pico.twin.placement import Placement

Place = Pose | Placement
_UPRIGHT = 3.0  # deg
_DOWN = 0.005  # m


def flat(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return poses seen from above."""
    return {name: at.pose if isinstance(at, Placement) else at for name, at in poses.items()}


def beam_paths(setup: Setup, poses: Mapping[str, Place]) -> Sequence[tuple[str, Vector, Vector]]:
    """Return (source, start, end) [mm] of each straight piece of the beams."""
    return [(axis.source, leg.start, leg.end) for axis in beams(setup, standing(poses)) for leg in axis.legs]


def standing(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return the poses of what stands on the table; what a hand holds, or what lies on its side, does not."""
    return flat({name: at for name, at in poses.items() if isinstance(at, Pose) or _stands(at)})


def _stands(at: Placement) -> bool:
    return at.tilt < _UPRIGHT and abs(at.position[2]) < _DOWN
