"""How far light on detectors is off from what it was because parts that were put down again stand otherwise, as far as
cameras saw it, and may be off because parts come to stand, and lasers point, only so well: by the nominal way of light.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from pico.geometry.seat import PlacementError, Seat
from pico.model.measurement import Restood
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import Values
from pico.optics.light import Light, light_of
from pico.optics.nominal.restood import Again
from pico.optics.unseen import SEEN, Unseen

WALK = 6e-4
"""How far the beam of a laser walks each way from one day to the next, one standard deviation [deg]."""
Three = tuple[float, float, float]
_STILL: Three = (0.0, 0.0, 0.0)
_SOME = 1e-9
"""What light of a part that is not in it changes by at most: a share, mm."""


@dataclass(frozen=True)
class Spread:
    """The light on a detector against what it was: one standard deviation of its power as a share of itself, and of its
    middle to the left and up [mm]. `moved`: by how much all three are others, as parts are seen to stand; `restood`:
    each of these, with what it makes of it alone."""

    power: float = 0.0
    left: float = 0.0
    up: float = 0.0
    moved: Three = _STILL
    restood: tuple[tuple[Restood, Three], ...] = ()


def spread(
    setup: Setup, poses: Mapping[str, Pose], values: Values, placed: Mapping[str, Again], detectors: Collection[str]
) -> dict[str, Spread]:
    """Return how far the light on each detector is off, and may be, where parts were put down again (`placed`), and the
    beams of lasers have walked; nothing for a detector in the dark."""
    nominal = {name: found for name, found in _seen(light_of(setup, poses, values), detectors).items() if found[0] > 0}
    squares = {name: [0.0, 0.0, 0.0] for name in nominal}
    twice = math.sqrt(2) * WALK
    walked = [Unseen(yaw=twice), Unseen(pitch=twice)]
    sources = [(name, walked) for name in poses if setup.type_of(name).optics.element == "source"]
    for part, errors in (*((name, _errors(setup, name, one.sigma)) for name, one in placed.items()), *sources):
        for off in errors:
            there = _seen(light_of(setup, poses, values, unseen={part: off}), nominal)
            for name, here in nominal.items():
                for k, by in enumerate(_change(here, there.get(name, (0.0, *here[1:])))):
                    squares[name][k] += by * by

    def since(*parts: str) -> dict[str, Three]:
        were = {**poses, **{part: placed[part].was for part in parts}}
        there = _seen(light_of(setup, were, values), nominal)
        return {n: _change(found, nominal[n]) for n, found in there.items()}

    moved = {part: one.seen for part, one in placed.items() if one.seen and one.was != one.now}
    alone, together = [(one, since(part)) for part, one in moved.items()], since(*moved) if moved else {}
    found = {}
    for name, of in squares.items():
        power, left, up = (math.sqrt(s) for s in of)
        told = ((one, there[name]) for one, there in alone if name in there and name in together)
        found[name] = Spread(
            power, left, up, together.get(name, _STILL), tuple(t for t in told if max(map(abs, t[1])) > _SOME)
        )
    return found


def _change(was: Three, now: Three) -> Three:
    """Return by which share power changes, and by how much the middle [mm]."""
    return now[0] / was[0] - 1, now[1] - was[1], now[2] - was[2]


def _errors(setup: Setup, part: str, one: PlacementError) -> Iterator[Unseen]:
    """Yield a placement that is off by one standard deviation in each way that tells; what leans does so about its
    foot, by which its optic is displaced as well."""
    about = setup.type_of(part).frames.optical
    found = [Unseen(ahead=one.x), Unseen(left=one.y), Unseen(yaw=one.yaw)]
    leans = (Seat(pitch=one.pitch), Seat(roll=one.roll), Seat(height=one.height))
    yield from (off for off in (*found, *(SEEN.sitting(seat, about) for seat in leans)) if off.displaced)


def _seen(light: Light, detectors: Collection[str]) -> dict[str, Three]:
    """Return power [mW] and middle [mm] of the light on each detector."""
    found = {}
    for name in detectors:
        arrivals = light.at(name)
        total = sum(a.power for a in arrivals)
        if total > 0 and not light.unfollowed(name):
            middle = [sum(a.power * a.center[k] for a in arrivals) / total for k in (0, 1)]
            found[name] = (total, middle[0], middle[1])
    return found
