"""Causes weighed by Bayes' theorem, each by its slope: see `pico.diagnosis.suspects`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause

ALIKE = 0.98
"""The cosine between what two causes do, by their noise, from which no reading tells them apart."""


@dataclass(frozen=True)
class Weighed:
    """A cause: the logarithm of its `evidence`, its likeliest `size` (k,) with covariance `spread` (k, k), and the
    `slope` (n, k) of the quantities where that was found."""

    evidence: float
    size: Any
    spread: Any
    slope: Any


def weighed(cause: Cause, slope: Any, spread: Any, d: Any) -> Weighed:
    """Return a cause of a slope (n, k) weighed by changes (n,) of covariance `spread` (n, n)."""
    prior = np.diag([w.fault**2 for w in cause.ways])
    whole = spread + slope @ prior @ slope.T
    size = prior @ slope.T @ np.linalg.solve(whole, d)
    covariance = prior - prior @ slope.T @ np.linalg.solve(whole, slope @ prior)
    evidence = normal(whole, d)
    for n, way in enumerate(cause.ways):
        if way.one_sided:
            evidence += math.log(max(1e-300, math.erfc(-size[n] / math.sqrt(2 * max(covariance[n, n], 1e-30)))))
    return Weighed(evidence, size, covariance, slope)


def normal(spread: Any, d: Any) -> float:
    """Return the logarithm of a normal density of mean 0, without the constant."""
    _, size = np.linalg.slogdet(spread)
    return float(-0.5 * d @ np.linalg.solve(spread, d) - 0.5 * size)


def direction(slope: Any, cause: Cause, spread: Any) -> Any:
    """Return what a cause does to the quantities, each way by its size, in units of the noise."""
    root = np.linalg.cholesky(np.linalg.inv(spread)).T
    return root @ (slope * np.array([w.fault for w in cause.ways]))


def alike(number: int, possible: Sequence[Cause], directions: Sequence[Any]) -> tuple[str, ...]:
    """Return the parts of which some cause spans what this one does, in their order."""
    own, found = directions[number], list[str]()
    for n, other in enumerate(directions):
        if possible[n].part == possible[number].part:
            continue
        base, _ = np.linalg.qr(other)
        kept, size = np.linalg.norm(base @ (base.T @ own)), np.linalg.norm(own)
        if size > 0 and kept / size > ALIKE:
            found.append(possible[n].part)
    return tuple(dict.fromkeys(found))
