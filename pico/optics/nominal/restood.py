"""How a part that was put down again stands against how it stood: as far as cameras saw both, else by the catalog."""

from __future__ import annotations

import math
from collections.abc import Mapping, Set
from dataclasses import dataclass

from pico.geometry.seat import PlacementError, scatter_of
from pico.model.measurement import Restood
from pico.model.observation import ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup


@dataclass(frozen=True)
class Again:
    """A part that was put down again, and stands at `now`. `was`: where it stood, which is `now` as far as cameras do
    not tell; `sigma`: one standard deviation of how it may stand otherwise against then, each way; `seen`: how far
    cameras saw it to stand from there, None where they did not."""

    was: Pose
    now: Pose
    sigma: PlacementError
    seen: Restood | None = None


def again(setup: Setup, component: str, then: ObservedComponent | None, now: ObservedComponent) -> Again:
    """Return how a part stands against how it was seen `then`; raises ValueError for one that has no pose now.

    Two placements differ by the square root of 2 of what the catalog says of one. What cameras saw both times counts
    instead where it is surer, in position and in yaw; how a part leans, and its height, they do not see. A part that
    stands farther off than two of its tolerances was put somewhere else, of which a placement tells nothing.
    """
    if now.pose is None:
        raise ValueError(f"{component} has no pose")
    one, twice = scatter_of(setup, component), math.sqrt(2)
    pitch, roll, height = twice * one.pitch, twice * one.roll, twice * one.height
    blind = PlacementError(twice * one.x, twice * one.y, twice * one.yaw, pitch, roll, height)
    if then is None or then.pose is None or not (_looked(then) and _looked(now)):
        return Again(now.pose, now.pose, blind)
    found, tolerance = _between(component, then, now, then.pose, now.pose), setup.type_of(component).pose.tolerance
    off = math.hypot(found.ahead, found.left)
    if off > 2 * tolerance.position or abs(found.turned) > 2 * tolerance.yaw:
        return Again(now.pose, now.pose, blind)
    placed, turned = found.position < blind.x, found.yaw < blind.yaw
    x, y = (then.pose.x, then.pose.y) if placed else (now.pose.x, now.pose.y)
    position, yaw = found.position if placed else blind.x, found.yaw if turned else blind.yaw
    was = Pose(x, y, then.pose.yaw if turned else now.pose.yaw)
    return Again(was, now.pose, PlacementError(position, position, yaw, pitch, roll, height), found)


def realigned(
    setup: Setup, parts: Set[str], then: Mapping[str, ObservedComponent], now: Mapping[str, ObservedComponent]
) -> bool:
    """Return whether a tunable of some parts that is aligned by light is set otherwise than it was then, or nobody
    knows."""
    for name in parts & then.keys() & now.keys():
        for tunable, kind in setup.type_of(name).tunables.items():
            if kind.restore.kind == "align":
                was, here = (part.values.get(tunable, ObservedValue()).value for part in (then[name], now[name]))
                known = isinstance(was, int | float) and isinstance(here, int | float)
                if not known or abs(float(here) - float(was)) > kind.tolerance:  # type: ignore[arg-type]
                    return True
    return False


def _looked(part: ObservedComponent) -> bool:
    """Whether cameras saw where a part stands, and nobody remembers it."""
    return part.presence == "seen" and part.how not in ("remembered", "placed")


def _between(component: str, then: ObservedComponent, now: ObservedComponent, was: Pose, pose: Pose) -> Restood:
    from_there = was.inverse().compose(pose)
    return Restood(
        component=component, ahead=from_there.x, left=from_there.y, turned=from_there.yaw,
        position=math.hypot(then.uncertainty.position, now.uncertainty.position),
        yaw=math.hypot(then.uncertainty.yaw, now.uncertainty.yaw),
    )  # fmt: skip
