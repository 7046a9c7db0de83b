"""What a bench would read over the size of one change of one part: exact at a few sizes, which light is traced for, and
between them by the polynomial through these.

Powers are smooth where their logarithms, and the nulls and centroids made of them, are not: near a null a slip of a
degree dims the light to nothing and lets it come again. So powers are interpolated, and centroids times their power;
then the laws of quantities are applied.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pico.diagnosis.causes import Way
from pico.diagnosis.nominal import ZERO, Nominal, Step
from pico.diagnosis.quantities import Got, Quantity, Shot, quantity

REACH = 3.0
"""Up to how many standard deviations of a fault is looked."""
_NODES = 5
_LEAKS = (0.1, 0.2)
"""Shares of the field that pass besides; power is a parabola of that share."""


@dataclass(eq=False)
class Curve:
    """One way of a part of a bench. `whole`: over the whole turn of an angle, of which powers have the harmonics up to
    the fourth (Malus twice), and not only within REACH."""

    nominal: Nominal
    part: str
    way: Way
    whole: bool = False
    _seen: dict[str, dict[str, NDArray[np.float64]] | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._stops = self.nominal.setup.type_of(self.part).number("extinction", "") or 1e5
        if self.whole:
            self._nodes = 180.0 / _NODES * (np.arange(_NODES) - _NODES // 2)
        elif self.way.what == "leak":
            self._nodes = np.array([math.sqrt(1 / self._stops), *_LEAKS])
        else:
            angles = np.pi * (2 * np.arange(_NODES) + 1) / (2 * _NODES)
            self._nodes = np.round(REACH * self.way.fault * np.cos(angles), 6)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """The sizes between which it can be asked."""
        if self.whole:
            return np.concatenate([side * np.arange(REACH, 90.0, 0.75) for side in (1.0, -1.0)])
        if self.way.what == "leak":
            return np.linspace(0.0, 2 * math.log(_LEAKS[-1] * math.sqrt(self._stops)), 41)
        return np.linspace(float(self._nodes.min()), float(self._nodes.max()), 81)

    def quantities(self, wanted: Sequence[Quantity], size: float) -> NDArray[np.float64]:
        """Return the values (n,) of quantities at a size, nan where nobody can say."""
        weights = self._weights(size)
        found = [self._quantity(one, weights, size) for one in wanted]
        return np.array([math.nan if one is None else one.value for one in found])

    def _quantity(self, wanted: Quantity, weights: NDArray[np.float64], size: float) -> Got | None:
        if all(shot.address.endswith((".dark", ".monitor")) for shot in wanted.shots):
            return self.nominal.quantity(wanted, (self._step(size),))
        readings = []
        for shot in wanted.shots:
            seen = self._at_nodes(shot)
            if seen is None or wanted.number not in seen:
                return None
            value = float(weights @ seen[wanted.number])
            if wanted.number in ("x", "y"):
                value /= float(weights @ seen["power"])
            readings.append((value, 0.0))
        return quantity(wanted, readings) if wanted.law != "share" or readings[0][0] > 0 else None

    def _at_nodes(self, shot: Shot) -> dict[str, NDArray[np.float64]] | None:
        """Return the numbers of a shot at the nodes; centroids times the power."""
        if shot.key not in self._seen:
            sizes = 2 * np.log(self._nodes * math.sqrt(self._stops)) if self.way.what == "leak" else self._nodes
            found = [self._numbers(shot, float(size)) for size in sizes]
            known = [f for f in found if f is not None]
            self._seen[shot.key] = (
                {n: np.array([f[n] for f in known]) for n in known[0]} if len(known) == len(found) else None
            )
        return self._seen[shot.key]

    def _numbers(self, shot: Shot, size: float) -> dict[str, float] | None:
        steps = (self._step(size),) if abs(size) > 1e-12 and self.nominal.matters(shot, self.part) else ()
        found = self.nominal.numbers(shot, steps)
        if found is None or "x" not in found:
            return None if found is None else dict(found)
        component = shot.address.partition(".")[0]
        power = sum(a.power for a in self.nominal.light(shot.at, steps).at(component))
        return {**found, "x": power * found["x"], "y": power * found["y"], "power": power}

    def _step(self, size: float) -> Step:
        return Step(self.part, self.way.what, round(float(size), 9))

    def _weights(self, size: float) -> NDArray[np.float64]:
        """Return the weights of the nodes: of a whole turn those of the trigonometric polynomial, else after
        Lagrange."""
        if self.whole:
            turned = np.radians(2.0 * (size - self._nodes))
            dirichlet: Any = (1 + 2 * sum(np.cos(k * turned) for k in range(1, _NODES // 2 + 1))) / _NODES
            return np.asarray(dirichlet, dtype=np.float64)
        at = math.exp(size / 2) / math.sqrt(self._stops) if self.way.what == "leak" else size
        nodes = self._nodes
        others = nodes[:, None] - nodes[None, :] + np.eye(len(nodes))
        away = np.where(np.eye(len(nodes), dtype=bool), 1.0, at - nodes[None, :])
        found: Any = np.prod(away / others, axis=1)
        return np.asarray(found, dtype=np.float64)


def bends(way: Way) -> bool:
    """Return whether what a way does is far from proportional to its size."""
    return way.what in ("leak", "retardance") or turns(way)


def turns(way: Way) -> bool:
    """Return whether a way turns a part about the beam, so that it does the same again after a turn."""
    return way.what in ("roll", f"{ZERO}angle")
