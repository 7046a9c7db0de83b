"""Where two arms of a bench may meet: the part of the table that both reach. Only one at a time may be there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

from pico.geometry import Shape, disc, polygon, separation
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.kinematics import joint_at, span
from pico.motion.types import Joints, MovePath

HAND = 80.0
"""How far a hand without a part reaches to the side of its axis [mm]."""
WIDTHS = (148.0, 126.0, 106.0)
"""Radii of discs that cover an arm whose joints 3 and 5 are at zero, as plans have them: along the lines from base to
joint 4, on to joint 6 and on to joint 7, at most 60 mm from one to the next [mm]. The first one covers any posture."""
MARGIN = 25.0
"""How far a plan keeps an arm from a zone that it does not hold [mm]: between two waypoints it is elsewhere, and on the
bench the path is found anew from where things really stand."""
_APART = 60.0  # mm, of the discs that cover a link
_STRAIGHT = 0.01  # rad, how far joints 3 and 5 may be from zero: less than 4 mm at the hand
_HEIGHTS = (50.0, 100.0, 150.0, 200.0)  # mm, besides the transit height: where the tool may be
_CORNERS = 48  # of a circle, drawn around it


@dataclass(frozen=True, slots=True)
class Zone:
    """What the two `robots` both reach, with anything in the hand: a convex polygon on the table, counter-clockwise
    [mm]. An arm that keeps out of it can't touch the other one wherever that is."""

    robots: tuple[str, str]
    corners: tuple[tuple[float, float], ...]

    @property
    def name(self) -> str:
        """The resource that an operation holds while its arm is in the zone."""
        return "zone/" + "+".join(self.robots)


def shared_zones(setup: Setup) -> tuple[Zone, ...]:
    """Return the zone of each pair of robots that meet, by name; a gantry meets every arm, all over its reach."""
    found = []
    for one, other in combinations(sorted(setup.lab.robots), 2):
        corners: tuple[tuple[float, float], ...] = _whole_table(setup)
        for name in (one, other):
            robot = setup.lab.robots[name]
            if robot.model == "xarm7":
                corners = _clipped(corners, (robot.mount.x, robot.mount.y), outermost(setup, robot))
        if len(corners) > 2:
            found.append(Zone((one, other), corners))
    return tuple(found)


def outermost(setup: Setup, robot: Robot) -> float:
    """Return the distance from the base's axis [mm] that no part of an arm, nor what it carries, comes beyond."""
    parts = [setup.type_of(name).geometry.footprint.radius for name in setup.lab.inventory if setup.movable(name)]
    reach = max(span(robot, z)[1] for z in (*_HEIGHTS, robot.transit_height))
    return reach + max([HAND, *parts])


def enters(setup: Setup, zone: Zone, path: MovePath, margin: float = 0.0) -> bool:
    """Return whether an arm or what it carries comes nearer than `margin` [mm] to `zone` anywhere on `path`, or into
    it; a gantry always does."""
    return any(
        within(setup, zone, path.robot, joints, path.component, margin)
        for segment in path.segments
        for joints in segment.joints
    )


def within(
    setup: Setup, zone: Zone, robot: str, joints: Joints, component: str | None = None, margin: float = 0.0
) -> bool:
    """Return whether an arm that stands so, `component` in its hand, is in `zone`, or nearer to it than `margin`
    [mm]; a gantry always is."""
    arm = setup.lab.robots[robot]
    if arm.model != "xarm7":
        return True
    area = polygon(zone.corners)
    carried = setup.type_of(component).geometry.footprint.radius if component else 0.0
    return any(separation(shape, area) <= margin for shape in _shadow(arm, joints, max(HAND, carried)))


def _shadow(robot: Robot, joints: Joints, hand: float) -> list[Shape]:
    """Discs on the table that cover an arm seen from above: along its links, and the hand with what it holds."""
    points = ((0.0, 0.0, 0.0), joint_at(joints, 4), joint_at(joints, 6), joint_at(joints, 7))
    c, s = math.cos(math.radians(robot.mount.yaw)), math.sin(math.radians(robot.mount.yaw))
    places = [(robot.mount.x + c * x - s * y, robot.mount.y + s * x + c * y) for x, y, _ in points]
    straight = all(abs(q) < _STRAIGHT for q in joints[2:5:2])
    widths = WIDTHS if straight else WIDTHS[:1] * 3
    discs = []
    for (ax, ay), (bx, by), width in zip(places, places[1:], widths, strict=False):
        count = max(1, math.ceil(math.hypot(bx - ax, by - ay) / _APART))
        shares = [i / count for i in range(count + 1)]
        discs += [disc(ax + (bx - ax) * t, ay + (by - ay) * t, width) for t in shares]
    return [*discs[:-1], disc(*places[-1], hand)]


def _whole_table(setup: Setup) -> tuple[tuple[float, float], ...]:
    x, y = setup.lab.table.size
    return ((0.0, 0.0), (x, 0.0), (x, y), (0.0, y))


def _clipped(
    corners: tuple[tuple[float, float], ...], center: tuple[float, float], radius: float
) -> tuple[tuple[float, float], ...]:
    """Return the part of a convex polygon within a polygon drawn around a circle (Sutherland and Hodgman)."""
    for i in range(_CORNERS):
        if not corners:
            break
        nx, ny = (f(2 * math.pi * i / _CORNERS) for f in (math.cos, math.sin))
        over = [(x - center[0]) * nx + (y - center[1]) * ny - radius for x, y in corners]
        kept: list[tuple[float, float]] = []
        for (a, p), (b, q) in zip(
            zip(over, corners, strict=True), zip((*over[1:], over[0]), (*corners[1:], corners[0]), strict=True),
            strict=True,
        ):  # fmt: skip
            if a <= 0:
                kept.append(p)
            if (a < 0 < b) or (b < 0 < a):
                t = a / (a - b)
                kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
        corners = tuple(kept)
    return corners
