"""Causes weighed by Bayes' theorem: see `pico.diagnosis.suspects`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause
from pico.diagnosis.responses import Response

ALIKE = 0.98
"""The cosine between what two causes do, by their noise, from which no reading tells them apart."""
GREAT, RARE = 10.0, 0.25
"""Of all faults, the share RARE is GREAT times as large as is usual."""
_STEPS = 6
"""How often a size is bettered, at most."""


@dataclass(frozen=True)
class Weighed:
    """A cause: the logarithm of its `evidence`, its likeliest `size` (k,) with covariance `spread` (k, k); what it does
    there, `moved` (n,), its `slope` (n, k) there, and the `prior` (k,) of its size, one standard deviation."""

    evidence: float
    size: Any
    spread: Any
    moved: Any
    slope: Any
    prior: Any


def weighed(response: Response, spread: Any, d: Any) -> Weighed:
    """Return a cause weighed by changes (n,) of covariance `spread` (n, n), at the size that explains them best."""
    size = _likeliest(response, spread, d)
    return at_size(response.cause, size, response.at(size), response.slope_at(size), spread, d)


def modes(response: Response, spread: Any, d: Any) -> list[Weighed]:
    """Return a cause weighed as by `weighed`, at its best size, and at the best on the other side of nothing: what dims
    light does so whichever way a part went."""
    first = weighed(response, spread, d)
    if not response.cause.ways or response.cause.ways[0].one_sided:
        return [first]
    other = response.sizes @ first.size < 0
    if not other.any():
        return [first]
    size = _likeliest(response, spread, d, other)
    second = at_size(response.cause, size, response.at(size), response.slope_at(size), spread, d)
    return [first, second] if size @ first.size < 0 and math.isfinite(second.evidence) else [first]


def at_size(cause: Cause, size: Any, moved: Any, slope: Any, spread: Any, d: Any) -> Weighed:
    """Return a cause weighed near a size (k,), by what it does there (n,) and its slope (n, k): its size is usual for a
    fault, or, RARE, GREAT times as much."""
    if not np.all(np.isfinite(moved)):
        return Weighed(-math.inf, size, np.zeros((len(size), len(size))), moved, slope, np.zeros(len(size)))
    left = d - moved + slope @ size
    found = []
    for share, times in ((1 - RARE, 1.0), (RARE, GREAT)):
        scale = times * np.array([w.fault for w in cause.ways])
        found.append((math.log(share), *_linear(cause, scale, slope, spread, left), scale))
        if not cause.ways:
            break
    whole = float(np.logaddexp.reduce([f[0] + f[1] for f in found])) if cause.ways else found[0][1]
    _, _, best, covariance, scale = max(found, key=lambda f: f[0] + f[1])
    return Weighed(whole, best, covariance, moved + slope @ (best - size), slope, scale)


def _linear(cause: Cause, scale: Any, slope: Any, spread: Any, left: Any) -> tuple[float, Any, Any]:
    """Return the logarithm of the evidence, the likeliest size (k,) and its covariance (k, k) by a slope alone."""
    prior = np.diag(scale**2)
    whole = spread + slope @ prior @ slope.T
    gain = prior @ slope.T @ np.linalg.inv(whole)
    size, covariance = gain @ left, prior - gain @ slope @ prior
    evidence = normal(whole, left)
    for n, way in enumerate(cause.ways):
        if way.one_sided:
            evidence += one_sided(float(size[n]), float(covariance[n, n]))
    return evidence, size, covariance


def one_sided(size: float, variance: float) -> float:
    """Return the logarithm of what the evidence of a way that only grows is multiplied by."""
    return math.log(max(1e-300, math.erfc(-size / math.sqrt(2 * max(variance, 1e-30)))))


def prior_at(cause: Cause, size: Any) -> Any:
    """Return the standard deviations (k,) of the sizes of those faults of a cause, usual or GREAT, which one of a size
    (k,) rather is."""
    fault = np.array([w.fault for w in cause.ways])
    far = float(((size / fault) ** 2).sum())
    usual = math.log(1 - RARE) - far / 2
    great = math.log(RARE) - len(fault) * math.log(GREAT) - far / GREAT**2 / 2
    return fault * (GREAT if great > usual else 1.0)


def share_of(found: Weighed, cause: Cause) -> float:
    """Return the logarithm of the share of faults that are as large as the prior of a cause takes it to be."""
    if not cause.ways:
        return 0.0
    return math.log(RARE if found.prior[0] > cause.ways[0].fault * math.sqrt(GREAT) else 1 - RARE)


def _likeliest(response: Response, spread: Any, d: Any, among: Any = True) -> Any:
    """Return the size (k,) that explains changes best: of those that are known, `among` these (m,), then bettered."""
    ways = response.cause.ways
    if not ways:
        return np.zeros(0)
    root = np.linalg.inv(np.linalg.cholesky(spread))
    scale = np.array([GREAT * w.fault for w in ways])
    known = np.where(np.isfinite(response.moved), response.moved, 1e6)
    left = (d - known) @ root.T
    misfit = (left**2).sum(axis=1) + ((response.sizes / scale) ** 2).sum(axis=1)
    for n, way in enumerate(ways):
        if way.one_sided:
            misfit = np.where(response.sizes[:, n] < 0, misfit + 1e9, misfit)
    best = int(np.where(among, misfit, np.inf).argmin())
    size, least = response.sizes[best], float(misfit[best])
    damping = 0.0
    for _ in range(_STEPS):
        slope = root @ response.slope_at(size)
        if not np.all(np.isfinite(slope)):
            return size
        near = slope.T @ slope + np.diag(1 / scale**2)
        step = np.linalg.solve(
            near + damping * np.diag(np.diag(near)), slope.T @ (root @ (d - response.at(size))) - size / scale**2
        )
        there = size + step
        off = root @ (d - response.at(there))
        now = float(off @ off + ((there / scale) ** 2).sum())
        if now < least - 1e-6:
            size, least, damping = there, now, damping / 4
        elif damping > 10:
            break
        else:
            damping = max(0.1, 8 * damping)
    return size


def normal(spread: Any, d: Any) -> float:
    """Return the logarithm of a normal density of mean 0, without the constant."""
    _, size = np.linalg.slogdet(spread)
    return float(-0.5 * d @ np.linalg.solve(spread, d) - 0.5 * size)


def direction(found: Weighed, cause: Cause, spread: Any) -> Any:
    """Return what a cause does to the quantities (n, k), each way by its size, in units of the noise; of one without a
    size all that it does."""
    root = np.linalg.cholesky(np.linalg.inv(spread)).T
    if not cause.ways:
        return root @ np.where(np.isfinite(found.moved), found.moved, 0.0)[:, None]
    slope = np.where(np.isfinite(found.slope), found.slope, 0.0)
    return root @ (slope * np.array([w.fault for w in cause.ways]))


def alike(number: int, possible: Sequence[Cause], directions: Sequence[Any]) -> tuple[str, ...]:
    """Return the parts of which some cause spans what this one does, in their order."""
    own, found = directions[number], list[str]()
    for n, other in enumerate(directions):
        if possible[n].part == possible[number].part or not other.any():
            continue
        base, sizes, _ = np.linalg.svd(other, full_matrices=False)
        base = base[:, sizes > 1e-6 * sizes[0]]
        kept, size = np.linalg.norm(base @ (base.T @ own)), np.linalg.norm(own)
        if size > 0 and kept / size > ALIKE:
            found.append(possible[n].part)
    return tuple(dict.fromkeys(found))
