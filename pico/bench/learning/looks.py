"""How the twin's looks scatter, and how noisy its cameras must be to scatter as the bench's do."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.trace.learned import Learned, Scatter
from pico.runs.robust import between

LOOKS = 8
"""How often the twin looks at its table to find how its looks scatter."""
STEPS = 3
"""How often the noise of its cameras is set anew."""
NEAR = 0.02
"""The share of a scatter within which that is met."""


@dataclass(frozen=True, slots=True)
class Matched:
    """The noise that was found, and how the twin's looks scatter `before` and `after`: position [mm], yaw [deg]."""

    noise: float
    before: tuple[float, float]
    after: tuple[float, float]


def scatter_of_looks(setup: Setup, root: Path, stood: Mapping[str, Pose], noise: float) -> tuple[float, float] | None:
    """Return how the poses of parts that stand still scatter from look to look of the twin, one standard deviation of
    position each way [mm] and of yaw [deg]; None where its cameras see none of them.

    `noise`: the factor on the noise of the cameras' sensors.
    """
    from pico.backends.sight import seen_by
    from pico.backends.sim.sight import Posed
    from pico.backends.sim.world import new_world
    from pico.twin.learned import with_noise
    from pico.vision.calibration_files import SIMULATED, known_arms, read_calibration
    from pico.vision.frame import exposed

    world, calibration = new_world(setup), read_calibration(root, SIMULATED)
    for name, pose in stood.items():
        world = world.with_body(name, pose=pose)
    names = [name for name, camera in sorted(setup.lab.cameras.items()) if camera.robot is None]
    eyes = Posed(with_noise(setup, Learned(noise=noise)), world, known_arms(root, SIMULATED)).eyes(world)
    seen: dict[str, list[Pose]] = defaultdict(list)
    for _ in range(LOOKS):
        sighting, _ = seen_by(setup, [exposed(partial(eyes.frame, name)) for name in names], calibration, set())
        for name in stood.keys() & sighting.components.keys():
            seen[name].append(sighting.components[name].pose)
    steps = [[(b.x - a.x, b.y - a.y, b.yaw - a.yaw) for a, b in pairwise(own)]
             for own in seen.values()]  # fmt: skip
    place = between([[step[axis] for step in own] for own in steps for axis in (0, 1)])
    turn = between([[(step[2] + 180) % 360 - 180 for step in own] for own in steps])
    return (place.value, turn.value) if place and turn else None


def noise_of(setup: Setup, root: Path, stood: Mapping[str, Pose], looks: Scatter, had: float) -> Matched | None:
    """Return how noisy the twin's cameras must be for its looks to scatter in position as the bench's do (`looks`),
    where they `had` a noise before; None where the bench's looks, or the twin's, tell nothing."""
    wanted = looks.position
    first = scatter_of_looks(setup, root, stood, had or 1.0) if wanted and wanted.value else None
    if wanted is None or first is None or not first[0]:
        return None
    noise, now = had or 1.0, first
    for _ in range(STEPS):
        if abs(now[0] / wanted.value - 1) <= NEAR:
            break
        noise = min(1000.0, max(0.001, noise * wanted.value / now[0]))
        now = scatter_of_looks(setup, root, stood, noise) or now
    return Matched(noise, first, now)
