"""An arm's shapes along one segment of a path, and how near they come to others: for the second check. In metres."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pico.motion.hulls import Hull, Placed, distance
from pico.motion.scene import Place

ROUNDING = 1e-9  # m

Array = Any
"""A numpy array of floats."""
Measure = Callable[[int, float], float]
"""The distance of two hulls in a configuration, known to be enough where it reaches the second number [m]."""


@dataclass(frozen=True, eq=False)
class Thing:
    """An obstacle: its hulls, and where its frame is."""

    name: str
    kind: Place
    hulls: tuple[Hull, ...]
    turn: Array
    origin: Array

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """The lower and the upper corner of a box around each hull: arrays (hulls, 3)."""
        centers = np.array([h.center for h in self.hulls]) @ self.turn.T + self.origin
        extents = np.array([h.extent(self.turn @ h.turn) for h in self.hulls])
        return centers - extents, centers + extents

    def placed(self, b: int) -> Placed:
        """Return one of its hulls where it stands."""
        hull = self.hulls[b]
        return Placed(hull).put(self.turn @ hull.turn, self.origin + self.turn @ hull.center)


class Leg:
    """One segment of a path in one frame: where each own hull is in each configuration."""

    def __init__(self, hulls: list[tuple[int, Hull]], turns: Array, origins: Array) -> None:
        """Take the hulls with the links that they are on, and rotations (N, 10, 3, 3) and origins (N, 10, 3)."""
        self.links = [i for i, _ in hulls]
        self.hulls = tuple(h for _, h in hulls)
        self.radii = np.array([h.radius for h in self.hulls])
        self._turns = turns
        self.centers = np.empty((len(turns), len(hulls), 3))
        for k, (i, hull) in enumerate(hulls):
            self.centers[:, k] = origins[:, i] + (turns[:, i].reshape(-1, 3) @ hull.center).reshape(-1, 3)
        self.parts = tuple(h.part for h in self.hulls)
        self._known: dict[int, tuple[Array, Array, Array]] = {}

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """The lower and the upper corner of a box around all ways of each hull: arrays (hulls, 3)."""
        return self.centers.min(axis=0) - self.radii[:, None], self.centers.max(axis=0) + self.radii[:, None]

    def boxes(self, k: int) -> tuple[Array, Array, Array]:
        """Return the rotations (N, 3, 3) of hull `k`, and the corners (N, 3) of the boxes around it."""
        if k not in self._known:
            turns = self._turns[:, self.links[k]] @ self.hulls[k].turn
            extents = self.hulls[k].extent(turns)
            self._known[k] = turns, self.centers[:, k] - extents, self.centers[:, k] + extents
        return self._known[k]

    def covered(self, k: int) -> Array:
        """How far no point of hull `k` has come beyond, since the first configuration: (N,).

        A point at most `radius` from the center goes no farther than the center does and the rotation carries it."""
        moved = np.linalg.norm(np.diff(self.centers[:, k], axis=0), axis=-1)
        turned = np.linalg.norm(np.diff(self._turns[:, self.links[k]], axis=0), axis=(-2, -1)) / math.sqrt(2)
        return np.concatenate(((0.0,), np.cumsum(moved + self.radii[k] * turned)))

    def near(self, k: int, floor: Array, ceiling: Array, required: float) -> Array:
        """Which configurations may bring hull `k` nearer than `required` to the box from `floor` to `ceiling`."""
        _, low, high = self.boxes(k)
        return np.maximum(floor - high, low - ceiling).max(axis=-1) < required + ROUNDING

    def measure(self, k: int, other: Callable[[int], Placed]) -> Measure:
        """Return what measures the distance of hull `k` from `other` in a configuration."""
        mine, turns = Placed(self.hulls[k]), self.boxes(k)[0]
        return lambda i, enough: distance(mine.put(turns[i], self.centers[i, k]), other(i), enough)


def moving(leg: Leg, m: int) -> Callable[[int], Placed]:
    other, turns = Placed(leg.hulls[m]), leg.boxes(m)[0]
    return lambda i: other.put(turns[i], leg.centers[i, m])


def still(other: Placed) -> Callable[[int], Placed]:
    return lambda _: other


def march(near: Array, covered: Array, required: float, measure: Measure) -> float | None:
    """Return the first distance that is less than `required`, or None: after each measurement the shape may go as far
    as it was seen to be free."""
    free = -1.0
    for i in np.flatnonzero(near).tolist():
        if covered[i] <= free:
            continue
        gap = measure(i, required + ROUNDING)
        if gap < required or gap <= 0.0:
            return gap
        free = covered[i] + gap - required
    return None
