"""Outlines of footprints on the table, as corners in mm."""

from __future__ import annotations

import math

from pico.drawing.canvas import Point
from pico.model.catalog import Footprint
from pico.model.pose import Pose


def outline(footprint: Footprint, pose: Pose) -> list[Point]:
    """Return the corners of a footprint at a pose; a disc has 48."""
    if footprint.disc is not None:
        return circle((pose.x, pose.y), footprint.disc, 48)
    return [pose.apply(x, y) for x, y in footprint.vertices]


def circle(center: Point, radius: float, count: int) -> list[Point]:
    """Return `count` points of a circle."""
    angles = (2 * math.pi * i / count for i in range(count))
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def square(pose: Pose, half: float) -> list[tuple[float, float]]:
    """Return the corners of a square around a pose [mm], `half` of a side from its middle."""
    return [pose.apply(x * half, y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
