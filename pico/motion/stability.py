"""Whether a part stays where it is put down: its center of mass over what it stands on, tilt, and push of the pads."""

from __future__ import annotations

import math

from pico.geometry import Shape, disc, placed, polygon, separation
from pico.geometry.mass import bodies_of, center_of_mass, touches
from pico.model.body import Body
from pico.model.catalog import Geometry
from pico.model.pose import Pose
from pico.motion.types import Blocked

EDGE = 3.0
"""Least distance of the center of mass from the edge of what the part stands on, seen from above [mm]."""
TILT = 10.0
"""A part must come back from a lean of so much [deg]."""
PUSH = 0.1
"""What the pads push the part sideways with when one lets go before the other, at most [N]; an assumption."""
_GRAVITY = 9.81  # m/s2
_CORNERS = 16  # of a round base, inscribed


def check_stability(component: str, geometry: Geometry) -> Blocked | None:
    """Return why `component` might topple where it is put down, or None where it stands.

    Its mass is where the twin has it. It tips over the nearest edge at a lean of atan(d / z), and under a push of
    m g d / h, with d from there to the edge, z the height of the center of mass and h that of the grasp.
    """
    x, y, z = center_of_mass(geometry)
    edge = min(-separation(disc(x, y, 0.0), base) for base in _bases(geometry))
    if edge < EDGE:
        where = f"{-edge:.3g} mm outside" if edge < 0 else f"only {edge:.3g} mm from the edge of"
        text = f"{component} would topple when it is let go: its center of mass is {where} what it stands on"
        return Blocked("unstable", text, "release", by=EDGE - edge, help=f"{EDGE:.3g} mm are needed: {_WIDER}")
    tilt = math.degrees(math.atan2(edge, z))
    if tilt < TILT:
        text = (
            f"{component} is too tall and thin to be let go: it topples at a lean of {tilt:.1f}°,"
            f" its center of mass {z:.3g} mm high and {edge:.3g} mm from its edge"
        )
        needed = z * math.tan(math.radians(TILT)) - edge
        return Blocked("unstable", text, "release", by=needed, help=f"{TILT:.3g}° are needed: {_WIDER}")
    push = geometry.mass * _GRAVITY * edge / geometry.grasp.height if geometry.grasp and geometry.mass else math.inf
    if push < PUSH:
        text = (
            f"{component} is too light to be let go so high: a push of {push:.2g} N where it is held topples it,"
            f" and the pads push with up to {PUSH:.2g} N"
        )
        return Blocked("unstable", text, "release", help=f"hold it lower, {_WIDER}")
    return None


_WIDER = "give it a wider or heavier base, or let a person move it (`mover: person`)"


def _bases(geometry: Geometry) -> list[Shape]:
    """The footprint, and what of the housing touches the table."""
    footprint = placed(geometry.footprint, Pose(0.0, 0.0))
    standing = [p for body in bodies_of(geometry) if touches(body) for p in _outline(body)] if geometry.bodies else []
    hull = _convex_hull(standing)
    return [footprint, polygon(hull)] if len(hull) > 2 else [footprint]


def _outline(body: Body) -> list[tuple[float, float]]:
    """Corners of the part of a body that touches the table; of a lying cylinder a line."""
    pose = Pose(body.at[0], body.at[1], body.yaw)
    if body.shape == "cylinder" and body.axis == "z":
        r, turn = body.size[0] / 2, 2 * math.pi / _CORNERS
        return [pose.apply(r * math.cos(i * turn), r * math.sin(i * turn)) for i in range(_CORNERS)]
    x, y = body.size[0] / 2, body.size[1] / 2
    if body.shape == "cylinder":
        x, y = (y, 0.0) if body.axis == "x" else (0.0, y)
    return [pose.apply(sx * x, sy * y) for sx in (-1, 1) for sy in (-1, 1)]


def _convex_hull(points: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(set(points))
    chains = []
    for line in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for p in line:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 1e-9:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return (*chains[0], *chains[1]) if len(ordered) > 2 else ()


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
