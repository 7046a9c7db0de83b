"""What one cause does to the quantities of a bench, as a function of its size, from few traces of light.

Most is a parabola in what it changes: the logarithm of what couples into a fiber falls with the square of an offset,
and a centroid moves in proportion. What is no parabola is traced at some sizes and taken as linear between them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause
from pico.diagnosis.nominal import Step

_REACH = (0.1, 0.25, 0.5, 1.0, 1.6, 2.5, 4.0, 7.0, 12.0)
"""Sizes at which a cause is tried first, in those that are usual for a fault."""


LEVEL = ("dark",)
"""Ways that are far from a parabola over the size of a fault, and in proportion in what tells of them most."""


@dataclass(frozen=True, eq=False)
class Response:
    """Changes of quantities (n) by a `cause` of k ways: `moved` (m, n) at some `sizes` (m, k), and `slope` (n, k) where
    nothing has changed; of a smooth one `curved` (n, k, k), its second derivatives. `lowest`: see `shown`."""

    cause: Cause
    sizes: Any
    moved: Any
    slope: Any
    curved: Any | None = None
    lowest: Any = -np.inf

    @property
    def bends(self) -> bool:
        """Whether it is no parabola."""
        return bool(self.cause.ways) and self.curved is None

    def steps(self, size: Any) -> tuple[Step, ...]:
        """Return the changes of the model that a size (k,) is."""
        ways = zip(self.cause.ways, np.asarray(size).tolist(), strict=True)
        return tuple(Step(self.cause.part, way.what, by) for way, by in ways if by)

    def only(self, numbers: Sequence[int]) -> Response:
        """Return the same for some of the quantities."""
        curved = None if self.curved is None else self.curved[numbers]
        lowest = self.lowest if np.ndim(self.lowest) == 0 else self.lowest[numbers]
        return replace(self, moved=self.moved[:, numbers], slope=self.slope[numbers], curved=curved, lowest=lowest)

    def shown(self, lowest: Any) -> Response:
        """Return the same as instruments show it: no change is below the `lowest` (n,), where no light comes any more
        it is that."""
        return replace(self, moved=shown(self.moved, lowest), lowest=lowest)

    def at(self, size: Any) -> Any:
        """Return the changes (n,) at a size (k,)."""
        if not self.cause.ways:
            return self.moved[0]
        if self.curved is not None:
            return shown(self.slope @ size + 0.5 * np.einsum("nij,i,j->n", self.curved, size, size), self.lowest)
        low, share = self._stretch(float(size[0]))
        return (1 - share) * self.moved[low] + share * self.moved[low + 1]

    def slope_at(self, size: Any) -> Any:
        """Return the derivatives (n, k) at a size (k,)."""
        if not self.cause.ways:
            return self.slope
        if self.curved is not None:
            slope = self.slope + np.einsum("nij,j->ni", self.curved, size)
            return np.where((self.at(size) > self.lowest)[:, None], slope, 0.0)
        low, _ = self._stretch(float(size[0]))
        return ((self.moved[low + 1] - self.moved[low]) / (self.sizes[low + 1] - self.sizes[low]))[:, None]

    def _stretch(self, size: float) -> tuple[int, float]:
        """Return between which sizes one lies, and where between them."""
        known = self.sizes[:, 0]
        low = int(np.clip(np.searchsorted(known, size) - 1, 0, len(known) - 2))
        return low, float((size - known[low]) / (known[low + 1] - known[low]))


def shown(changes: Any, lowest: Any) -> Any:
    """Return changes (..., n) as instruments show them: where no light comes any more (nan), as much as they can."""
    dark = np.isfinite(lowest) & ~np.isfinite(changes)
    return np.maximum(np.where(dark, -np.inf, changes), lowest)


def constant(cause: Cause, dark: Any) -> Response:
    """Return the response of a cause without a size, that leaves quantities in the dark where `dark` (n,) is true."""
    return Response(cause, np.zeros((1, 0)), np.where(dark, -np.inf, 0.0)[None, :], np.zeros((len(dark), 0)))


def between(cause: Cause, rows: Mapping[float, Any]) -> Response:
    """Return the response of a cause of one way from changes (n,) at some sizes."""
    sizes = sorted(rows)
    moved = np.stack([rows[s] for s in sizes])
    least = min(range(len(sizes)), key=lambda n: abs(sizes[n]))
    near = max(least, 1)
    slope = (moved[near] - moved[near - 1]) / (sizes[near] - sizes[near - 1])
    return Response(cause, np.array(sizes)[:, None], moved, np.where(np.isfinite(slope), slope, 0.0)[:, None])


def denser(rows: Mapping[float, Any], times: int = 6) -> dict[float, Any]:
    """Return changes (n,) at some sizes with others between them, by the cubics that go through these with the slopes
    of parabolas (Catmull and Rom); linear where a neighbor is not known."""
    sizes = np.array(sorted(rows))
    known = np.stack([rows[s] for s in sizes])
    with np.errstate(invalid="ignore"):
        steep = (known[1:] - known[:-1]) / np.diff(sizes)[:, None]
        ahead, back = np.diff(sizes)[1:, None], np.diff(sizes)[:-1, None]
        middle = (steep[:-1] * ahead + steep[1:] * back) / (ahead + back)
    slopes = np.concatenate([steep[:1], middle, steep[-1:]])
    found = {}
    for n, width in enumerate(np.diff(sizes)):
        low, high = (np.where(np.isfinite(slopes[k]), slopes[k], steep[n]) * width for k in (n, n + 1))
        for t in np.arange(times) / times:
            a, b = t * (1 - t) ** 2, -(t**2) * (1 - t)
            share = t * t * (3 - 2 * t)
            found[float(sizes[n] + t * width)] = (1 - share) * known[n] + share * known[n + 1] + a * low + b * high
    found[float(sizes[-1])] = known[-1]
    return found


def smooth(cause: Cause, steps: Sequence[float], changes: Callable[[Sequence[float], bool], Any]) -> Response:
    """Return the response of a cause by its first and second derivatives, from `changes` (n,) at sizes of some `steps`,
    with scans or without; 0 where these are not known. A scan is taken to change in proportion."""
    k = len(steps)
    axes = [[s if n == m else 0.0 for m in range(k)] for n, s in enumerate(steps)]
    ups, downs = [changes(a, True) for a in axes], [changes([-x for x in a], False) for a in axes]
    pairs = list(zip(ups, downs, steps, strict=True))
    slope = np.stack([np.where(np.isfinite(d), (u - d) / (2 * s), u / s) for u, d, s in pairs], axis=1)
    curved = np.zeros((len(slope), k, k))
    for n, (u, d, s) in enumerate(pairs):
        curved[:, n, n] = (u + d) / s**2
    if k == 2:
        both = changes(steps, False)
        curved[:, 0, 1] = curved[:, 1, 0] = (both - ups[0] - ups[1]) / (steps[0] * steps[1])
    slope, curved = (np.where(np.isfinite(one), one, 0.0) for one in (slope, curved))
    if any(w.what in LEVEL for w in cause.ways):
        curved[:] = 0.0
    faults = np.array([w.fault for w in cause.ways])
    slope = np.where(np.abs(slope) * faults > 1e-7, slope, 0.0)
    curved = np.where(np.abs(curved) * faults[:, None] * faults[None, :] > 1e-6, curved, 0.0)
    sizes = _tried(cause)
    moved = sizes @ slope.T + 0.5 * np.einsum("nij,mi,mj->mn", curved, sizes, sizes)
    return Response(cause, sizes, moved, slope, curved)


def linear(cause: Cause, slopes: Sequence[Any]) -> Response:
    """Return the response of a cause of some ways in proportion to its size, by the `slopes` (n,) of each way."""
    slope, sizes = np.stack(slopes, axis=1), _tried(cause)
    return Response(cause, sizes, sizes @ slope.T, slope, np.zeros((*slope.shape, len(slopes))))


def _tried(cause: Cause) -> Any:
    """Return the sizes (m, k) at which a cause is tried first, nothing among them."""
    line = [0.0, *(s for r in _REACH for s in (r, -r))]
    return np.array(list(product(*([w.fault * s for s in line] for w in cause.ways))))
