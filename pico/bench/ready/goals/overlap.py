"""Two arms of an interferometer on top of one another, on a near camera and a far one: a shutter in each arm shows one
after the other, and what moves one of them brings it to where the other is."""

from __future__ import annotations

from pico.model.goal import Budget, Goal
from pico.model.quantities import Value
from pico.planning.asked import Asked, Ready
from pico.planning.nominal_bench import STEERS

TAKES = "[MIRROR MIRROR] NEAR FAR: two arms one on the other on both cameras, to 10 um"
LEAST = 2
NEAR = 10.0
"""How near is near enough [um]."""


def make(asked: Asked) -> Ready:
    """Return the goal of two cameras; mirrors of one arm, and a shutter in each, are found where they are not named."""
    *named, near, far = (asked.part(word) for word in asked.words)
    cameras = [asked.camera(near), asked.camera(far)]
    arms = _arms(asked, near)
    shutters = [_shutter(asked, arm, near) for arm in arms]
    mirrors = named or _steered(asked, arms)
    tunables = {a: b for mirror in mirrors for a, b in asked.bounds(mirror, *STEERS).items()}
    one, other = asked.look("one"), asked.look("other")
    looks: dict[str, dict[str, Value]] = {
        one: {shutters[0]: "open", shutters[1]: "closed"}, other: {shutters[0]: "closed", shutters[1]: "open"},
    }  # fmt: skip
    apart = [f"{one}.{c}.centroid.{axis} - {other}.{c}.centroid.{axis}" for c in cameras for axis in ("x", "y")]
    return Ready(asked.name, Goal(
        tunables=tunables, reach=dict.fromkeys(apart, 0.0), tolerance=NEAR, looks=looks,
        budget=Budget(measurements=80, seconds=900.0),
    ))  # fmt: skip


def _arms(asked: Asked, camera: str) -> tuple[list[str], list[str]]:
    """Return what each of two ways to a camera meets that the other does not."""
    ways = asked.ways(camera)
    if len(ways) != 2:
        text = f"{len(ways)} beams come to {camera}, not those of two arms"
        raise asked.refused(text, "`pico beam` shows where beams run")
    one, other = ([n for n in way[:-1] if n] for way in ways)
    return [n for n in one if n not in other], [n for n in other if n not in one]


def _shutter(asked: Asked, arm: list[str], camera: str) -> str:
    """Return the address of the shutter in an arm; raises PicoError where there is none."""
    found = next((n for n in arm if asked.element(n) == "shutter" and asked.has(n, "shutter")), None)
    if found is None:
        text = f"nothing can stop the beam that comes to {camera} by {', '.join(arm) or 'one of the arms'}"
        raise asked.refused(text, "a shutter in each arm: two spots at once can't be told apart")
    return f"{found}.shutter"


def _steered(asked: Asked, arms: tuple[list[str], list[str]]) -> list[str]:
    """Return the two last mirrors of an arm that motors tip and tilt; raises PicoError where no arm has two."""
    for arm in arms:
        own = [n for n in arm if asked.has(n, *STEERS)]
        if len(own) >= 2:
            return own[-2:]
    raise asked.refused("no arm has two mirrors with motors for tip and tilt", "name what else is to be tuned")
