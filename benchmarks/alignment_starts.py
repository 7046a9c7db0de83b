"""From where the alignments of `alignment.py` begin: parts put down as the catalog says of their seats, in a world that
drifts. Offsets are pairs, across the table and up; lengths in mm, angles in mrad.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pico.geometry.seat import PlacementError, scatter
from pico.manifest.catalog import packaged_type
from pico.model.simulated import Environment
from pico.optics.environment import Disturbed, disturbed

SEEN = PlacementError(x=0.02, y=0.02, yaw=0.01)
"""How well cameras see where a part stands, one standard deviation: half of what is 95 % of `benchmarks/scan.py
--errors`."""
WALLS = 8 * 3600.0
"""Within how many seconds of its bench's life an alignment begins."""
Array = np.ndarray


@dataclass(frozen=True)
class Seated:
    """A part that was put down: how far its optic stands off its goal across the light and up [mm], how far along it,
    and by how much the part is turned, to the left and up [mrad]."""

    off: Array
    along: float
    turned: Array


def sigmas(kind: str) -> Seated:
    """Return one standard deviation of how a type is put down."""
    found = packaged_type(kind)
    one, height = scatter(found.repeatability, found.seating), found.frames.optical[2]
    across = math.hypot(one.y, height * math.radians(one.roll))
    along = math.hypot(one.x, height * math.radians(one.pitch))
    return Seated(np.array([across, one.height]), along, np.radians([one.yaw, one.pitch]) * 1e3)


def put_down(rng: np.random.Generator, kind: str, *, seen: bool = False) -> Seated:
    """Draw how a part comes to stand. `seen`: but for x, y and yaw, which cameras saw and tunables made up for, as
    `pico optimize` has them do before it asks for light; of these is left by what cameras are wrong."""
    found = packaged_type(kind)
    one, height = scatter(found.repeatability, found.seating), found.frames.optical[2]
    if seen:
        one = PlacementError(SEEN.x, SEEN.y, SEEN.yaw, one.pitch, one.roll, one.height)
    x, y, yaw, pitch, roll, up = rng.normal(0, 1, 6) * [one.x, one.y, one.yaw, one.pitch, one.roll, one.height]
    ahead, left = x + height * math.radians(pitch), y - height * math.radians(roll)
    return Seated(np.array([left, up]), ahead, np.radians([yaw, pitch]) * 1e3)


def rolled(rng: np.random.Generator, kind: str) -> float:
    """Draw by how much a part that was put down is turned about the light [deg]."""
    found = packaged_type(kind)
    return float(rng.normal(0, scatter(found.repeatability, found.seating).roll))


def folded(mirrors: Sequence[Seated], arms: Sequence[float]) -> tuple[Array, Array]:
    """Return by how much mirrors that fold a beam by 90 degrees move it at a plane [mm] and turn it [mrad]; `arms` go
    from each to the plane [mm]."""
    moved, turned = np.zeros(2), np.zeros(2)
    for mirror, arm in zip(mirrors, arms, strict=True):
        moved = moved + 2 * mirror.turned * arm * 1e-3 + [math.sqrt(2) * mirror.along, 0.0]
        turned = turned + 2 * mirror.turned
    return moved, turned


class World:
    """What the simulated world does to light by the bench's clock: the drift of a laser, as the twin has it."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.began = float(np.random.default_rng([seed, 5]).uniform(0, WALLS))

    def at(self, seconds: float) -> Disturbed:
        """Return how the laser's beam is turned [mrad], and by which share its power is another, so long after."""
        return disturbed(Environment(), self.seed, "laser", self.began + seconds)
