"""What the simulated world does by itself: the beam walks, the power drifts, mirrors vibrate.

Pure: each is a function of the time on the bench's clock and a seed, without a memory, so a bench that is looked at
twice is the same world.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.simulated import Environment
from pico.optics.geometry import MIRRORS

_WARM = 900.0
"""How fast a laser warms up [s]."""
_SLOW = (300.0, 86400.0)
"""Periods of what walks [s]."""
_QUICK = (0.01, 0.1)
"""Periods of vibration [s]."""
_BENDS = 0.01
"""By how much a degree turns the way of a laser's beam [mrad/degC]."""


@dataclass(frozen=True, slots=True)
class Disturbed:
    """What the world does to a component: its beam is turned by `left` and `up` [mrad], its power is another by the
    share `power`, and it is displaced along its normal by `moved` [mm]."""

    left: float = 0.0
    up: float = 0.0
    power: float = 0.0
    moved: float = 0.0


def wander(seed: str, time: float, periods: tuple[float, float], count: int = 12) -> float:
    """Return what walks at random with a standard deviation of 1 at a time [s]: a sum of sines of random phase whose
    periods are spread evenly in their logarithm, so that it walks at each scale between them."""
    draw, total = random.Random(seed), 0.0
    short, long = (math.log(p) for p in periods)
    for n in range(count):
        period = math.exp(short + (long - short) * (n + draw.random()) / count)
        total += math.sin(2 * math.pi * (time / period + draw.random()))
    return total * math.sqrt(2 / count)


def temperature(environment: Environment, seed: int, time: float) -> float:
    """Return how far the room is from its mean temperature [degC] at a time [s]."""
    return environment.temperature * wander(f"{seed}/temperature", time, (3600.0, 86400.0))


def disturbed(environment: Environment, seed: int, name: str, time: float) -> Disturbed:
    """Return what the world does to a component at a time [s]."""
    key, warm = f"{seed}/{name}", environment.warm_up * math.exp(-max(time, 0.0) / _WARM)
    turned = _BENDS * temperature(environment, seed, time)
    way = random.Random(f"{key}/way").uniform(0, 2 * math.pi)
    return Disturbed(
        left=environment.pointing * wander(f"{key}/left", time, _SLOW) + (warm + turned) * math.cos(way),
        up=environment.pointing * wander(f"{key}/up", time, _SLOW) + (warm + turned) * math.sin(way),
        power=environment.power * wander(f"{key}/power", time, _SLOW),
        moved=environment.vibration * 1e-6 * wander(f"{key}/vibration", time, _QUICK),
    )


def in_the_world(
    setup: Setup, poses: Mapping[str, Pose], values: Mapping[str, Mapping[str, Any]], seed: int, time: float
) -> tuple[dict[str, Pose], dict[str, Mapping[str, Any]]]:
    """Return poses and tunables as light finds them at a time [s], with what the lab's environment does to them."""
    found, set_to = dict(poses), dict(values)
    environment = setup.lab.sim.environment or Environment()
    if environment == "none":
        return found, set_to
    for name in poses:
        kind = setup.type_of(name)
        if kind.optics.element == "source":
            it = disturbed(environment, seed, name, time)
            odd = float(values.get(name, {}).get("walk_power", 0.0))
            walked = {"walk_left": it.left, "walk_up": it.up, "walk_power": it.power + odd}
            set_to[name] = {**values.get(name, {}), **walked}
        elif kind.optics.element in MIRRORS:
            moved, turned = disturbed(environment, seed, name, time).moved, math.radians(poses[name].yaw)
            found[name] = replace(
                poses[name],
                x=poses[name].x - moved * math.cos(turned), y=poses[name].y - moved * math.sin(turned),
            )  # fmt: skip
    return found, set_to
