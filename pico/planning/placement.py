"""Where a component stands that is placed behind another along its beam."""

from __future__ import annotations

import math

from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.state import LabState, place_of


def place_after(setup: Setup, where: Observation | LabState, name: str, other: str, distance_mm: float) -> Pose:
    """Return the pose at which the optical center of `name` lies `distance_mm` behind that of `other`, along the beam
    axis of `other` (its local +x), facing the same way.

    Raises KeyError for a component that the lab does not have, or that is not seen.
    """
    pose = _pose(setup, where, other)
    x, y, _ = setup.type_of(other).frames.optical
    center = pose.apply(x + distance_mm, y)
    own_x, own_y, _ = setup.type_of(name).frames.optical
    c, s = math.cos(math.radians(pose.yaw)), math.sin(math.radians(pose.yaw))
    return Pose(center[0] - (c * own_x - s * own_y), center[1] - (s * own_x + c * own_y), pose.yaw)


def _pose(setup: Setup, where: Observation | LabState, name: str) -> Pose:
    if isinstance(where, LabState):
        return place_of(setup, where, name)[1]
    pose = where.components[name].pose
    if pose is None:
        raise KeyError(name)
    return pose
