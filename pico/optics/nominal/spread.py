"""How far light on detectors may be off because parts come to stand only so well, and lasers point only so well: by the
nominal way of light, to first order in what the catalog says of a placement."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from pico.geometry.seat import Seat, scatter_of
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import Values
from pico.optics.light import Light, light_of
from pico.optics.unseen import SEEN, Unseen

WALK = 6e-4
"""How far the beam of a laser walks each way from one day to the next, one standard deviation [deg]."""


@dataclass(frozen=True)
class Spread:
    """One standard deviation of the light on a detector: its power as a share of itself, and its middle to the left and
    up [mm]."""

    power: float = 0.0
    left: float = 0.0
    up: float = 0.0


def spread(
    setup: Setup, poses: Mapping[str, Pose], values: Values, placed: Collection[str], detectors: Collection[str]
) -> dict[str, Spread]:
    """Return how far the light on each detector may be off where each part of `placed` was put down once, and the beams
    of lasers have walked; nothing for a detector in the dark."""
    nominal = {name: found for name, found in _seen(light_of(setup, poses, values), detectors).items() if found[0] > 0}
    squares = {name: [0.0, 0.0, 0.0] for name in nominal}
    walked = [Unseen(yaw=WALK), Unseen(pitch=WALK)]
    sources = [(name, walked) for name in poses if setup.type_of(name).optics.element == "source"]
    for part, errors in (*((name, _errors(setup, name)) for name in placed), *sources):
        for off in errors:
            there = _seen(light_of(setup, poses, values, unseen={part: off}), nominal)
            for name, (power, left, up) in nominal.items():
                one = there.get(name, (0.0, left, up))
                for k, by in enumerate((one[0] / power - 1, one[1] - left, one[2] - up)):
                    squares[name][k] += by * by
    return {name: Spread(*(math.sqrt(s) for s in found)) for name, found in squares.items()}


def _errors(setup: Setup, part: str) -> list[Unseen]:
    """Return a placement that is off by one standard deviation in each way that tells; what leans does so about its
    foot, by which its optic is displaced as well."""
    one, about = scatter_of(setup, part), setup.type_of(part).frames.optical
    found = [Unseen(ahead=one.x), Unseen(left=one.y), Unseen(yaw=one.yaw)]
    leans = (Seat(pitch=one.pitch), Seat(roll=one.roll), Seat(height=one.height))
    return [off for off in (*found, *(SEEN.sitting(seat, about) for seat in leans)) if off.displaced]


def _seen(light: Light, detectors: Collection[str]) -> dict[str, tuple[float, float, float]]:
    """Return power [mW] and middle [mm] of the light on each detector."""
    found = {}
    for name in detectors:
        arrivals = light.at(name)
        total = sum(a.power for a in arrivals)
        if total > 0:
            middle = [sum(a.power * a.center[k] for a in arrivals) / total for k in (0, 1)]
            found[name] = (total, middle[0], middle[1])
    return found
