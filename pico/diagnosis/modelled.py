"""What the ray model says that a cause does to the quantities of a bench: its slope at nothing, and what it does at the
size which explains best what was read."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.curves import Curve, bends
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Quantity
from pico.diagnosis.weighing import Weighed, weighed

ROUNDS = 2
"""How often a cause of two ways is modelled anew."""
_CUTS = 16
"""How often the stretch in which a size lies is cut by the golden section: to 5e-4 of it."""
Slopes = dict[tuple[str, str], Any]


@dataclass(frozen=True, eq=False)
class Modelled:
    """Quantities (n) of a bench as the model has them."""

    nominal: Nominal
    wanted: tuple[Quantity, ...]

    def read(self, steps: Sequence[Step] = ()) -> Any:
        """Return the quantities (n,) after some changes, nan where the model does not tell."""
        found = [self.nominal.quantity(one, steps) for one in self.wanted]
        return np.array([math.nan if one is None else one.value for one in found])

    def slopes(self, possible: Sequence[Cause]) -> Slopes:
        """Return the derivatives (n,) of the quantities by each way of each part, 0 where the model does not tell."""
        key = (repr(self.wanted), tuple(possible))
        ways = [(cause.part, way) for cause in possible for way in cause.ways]
        return self.nominal.kept("slopes", key, lambda: {(part, w.what): self._slope(part, w) for part, w in ways})

    def _slope(self, part: str, way: Way) -> Any:
        slope = (self.read((Step(part, way.what, way.step),)) - self.read()) / way.step
        return np.where(np.isfinite(slope) & (np.abs(slope) * way.fault > 1e-9), slope, 0.0)

    def nearer(self, cause: Cause, at: Weighed, spread: Any, d: Any) -> Weighed:
        """Return a cause weighed anew where it is likeliest by the model itself; `at`: by its slope at nothing."""
        if len(cause.ways) == 1 and bends(cause.ways[0]):
            return self._along(cause, at, spread, d)
        best = at
        for _ in range(ROUNDS):
            if all(abs(s) < 2 * w.step for s, w in zip(best.size, cause.ways, strict=True)):
                break
            steps = (Step(cause.part, w.what, float(s)) for w, s in zip(cause.ways, best.size, strict=True))
            there = self.read(tuple(steps)) - self.read()
            moved = np.where(np.isfinite(there), there, at.slope @ best.size)
            best = weighed(cause, at.slope, spread, d - moved + at.slope @ best.size)
        return best

    def _along(self, cause: Cause, at: Weighed, spread: Any, d: Any) -> Weighed:
        """Return a cause that bends, weighed at the size that explains most, of all up to `curves.REACH` times what is
        usual for a fault."""
        (way,) = cause.ways
        curve = self.nominal.kept("curve", (cause.part, way.what), lambda: Curve(self.nominal, cause.part, way))
        base, inverse = self.read(), np.linalg.inv(spread)

        def moved(size: float) -> Any:
            there = curve.quantities(self.wanted, size) - base
            return np.where(np.isfinite(there), there, at.slope[:, 0] * size)

        def misfit(size: float) -> float:
            left = d - moved(size)
            return float(left @ inverse @ left) + (size / way.fault) ** 2

        sizes = curve.sizes.tolist()
        size = _least(misfit, sizes)
        low, high = max(sizes[0], size - way.step / 50), size + way.step / 50
        slope = ((moved(high) - moved(low)) / (high - low))[:, None]
        return weighed(cause, slope, spread, d - moved(size) + slope[:, 0] * size)


def _least(of: Callable[[float], float], sizes: Sequence[float]) -> float:
    """Return where a function is least, by the golden section about each size at which it is less than beside it."""
    seen, last = [of(size) for size in sizes], len(sizes) - 1
    least = [n for n in range(len(seen)) if seen[n] == min(seen[max(0, n - 1) : n + 2])]
    return min((_cut(of, sizes[max(0, n - 1)], sizes[min(last, n + 1)]) for n in least), key=of)


def _cut(of: Callable[[float], float], low: float, high: float) -> float:
    share = (math.sqrt(5) - 1) / 2
    for _ in range(_CUTS):
        left, right = high - share * (high - low), low + share * (high - low)
        low, high = (low, right) if of(left) < of(right) else (left, high)
    return (low + high) / 2
