"""What a few data, some of them outliers, tell of their scatter, and how surely.

Outliers are what lies farther than `CUT` scaled median absolute deviations from the median (the identifier of F. R.
Hampel, J. Am. Stat. Assoc. 69, 383 (1974)); a normal datum is one in 16,000 times. The standard error of a standard
deviation with n degrees of freedom is that over sqrt(2 n) (JCGM 100:2008, the GUM, E.4.3).
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

CUT = 4.0
MAD = 1.4826
"""A standard deviation in median absolute deviations, of normal data."""
FEW = 15
"""Below so many data the median absolute deviation itself is too uncertain to cut by it alone: twice as far, then."""


@dataclass(frozen=True, slots=True)
class Found:
    """A value with its standard error, the number of data that it rests on, and how many were outliers."""

    value: float
    sigma: float
    count: int
    outliers: int = 0


def inliers(values: Sequence[float]) -> list[int]:
    """Return the indices of the data that are no outliers; all, where most are alike."""
    middle = statistics.median(values) if values else 0.0
    scale = MAD * statistics.median(abs(value - middle) for value in values) if values else 0.0
    limit = scale * CUT * (1 if len(values) >= FEW else 2) or math.inf
    return [i for i, value in enumerate(values) if abs(value - middle) <= limit]


def scatter(groups: Sequence[Sequence[float]], known: Sequence[Sequence[float]]) -> Found | None:
    """Return one standard deviation of data about the mean of their group, the same in all groups, without what is
    `known` to add to each datum (one standard deviation each, which adds as squares). None where nothing is left.

    Where the data scatter less than what is known to add to them, it is 0, and `sigma` what it might be.
    """
    squares, freedom, adds, count, total = 0.0, 0, 0.0, 0, 0
    for values, sigmas in zip(groups, known, strict=True):
        kept = inliers(values)
        total += len(values)
        if len(kept) < 2:
            continue
        mean = statistics.fmean(values[i] for i in kept)
        squares += sum((values[i] - mean) ** 2 for i in kept)
        adds += sum(sigmas[i] ** 2 for i in kept)
        freedom += len(kept) - 1
        count += len(kept)
    if not freedom:
        return None
    variance = squares / freedom
    left = max(0.0, variance - adds / count)
    error = variance * math.sqrt(2 / freedom)  # of the variance
    value = math.sqrt(left)
    most = math.sqrt(error)
    return Found(value, min(error / (2 * value), most) if value else most, count, total - count)


def between(steps: Sequence[Sequence[float]]) -> Found | None:
    """Return one standard deviation of single data of which only the differences between one and the next are known, in
    groups; None where there are none. A slow drift does not count, nor does what jumped in between.

    Half the mean square successive difference, whose relative standard error is sqrt(3 / n): J. von Neumann, Ann. Math.
    Stat. 12, 367 (1941).
    """
    kept = [[one for one in group if abs(one) <= _reach(group)] for group in steps]
    found = [one for group in kept for one in group]
    if not found:
        return None
    value = math.sqrt(sum(one**2 for one in found) / (2 * len(found)))
    return Found(value, value * math.sqrt(3 / len(found)) / 2, len(found), sum(map(len, steps)) - len(found))


def _reach(steps: Sequence[float]) -> float:
    """Return how far differences may be from 0 that are no outliers."""
    scale = MAD * statistics.median(abs(one) for one in steps) if steps else 0.0
    return scale * CUT * (1 if len(steps) >= FEW else 2) or math.inf


def ratio(measured: Sequence[float], reckoned: Sequence[float]) -> Found | None:
    """Return by what all of `reckoned` are to be multiplied to have the sum of what was `measured`, but for pairs whose
    own ratio is an outlier; None where there are none above 0.

    The ratio estimator, W. G. Cochran, Sampling Techniques, 3rd ed. (1977), chapter 6.
    """
    pairs = [(m, r) for m, r in zip(measured, reckoned, strict=True) if m > 0 and r > 0]
    kept = [pairs[i] for i in inliers([math.log(m / r) for m, r in pairs])]
    if len(kept) < 2:
        return None
    sum_of = sum(r for _, r in kept)
    value = sum(m for m, _ in kept) / sum_of
    residual = sum((m - value * r) ** 2 for m, r in kept) * len(kept) / (len(kept) - 1)
    return Found(value, math.sqrt(residual) / sum_of, len(kept), len(pairs) - len(kept))
