"""Which configuration to try next, so that the one that broke something is found in the least time at the bench.

Pure: commits are numbers, parents before children, the last of them is the one known to be bad; costs are passed in.
Halving counts trials alike; here a trial costs what the bench needs to get there, and the measurement. On a line of
history the least expected time is found exactly (every order of trials, by intervals); where branches meet, the commit
with the most information per second is taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

MOST = 400
"""Of how many commits of a line the least time is found exactly; the work grows with their cube."""


@dataclass(frozen=True)
class Suspects:
    """Commits that may be the first bad one, each with the numbers of its parents among them.

    `weight`: how likely each is the first bad one, in any unit; 0 where it changed nothing. `testable`: those worth
    trying; never the last, which is known to be bad. `skipped`: those of which nobody could tell.
    """

    parents: Sequence[Sequence[int]]
    weight: Sequence[float]
    testable: frozenset[int]
    skipped: frozenset[int] = frozenset()

    @property
    def linear(self) -> bool:
        """Whether each has the one before it as its only parent."""
        return all(tuple(p) == ((n - 1,) if n else ()) for n, p in enumerate(self.parents))

    def ancestors(self) -> list[int]:
        """Return, for each, itself and its ancestors as bits of a number."""
        found: list[int] = []
        for n, parents in enumerate(self.parents):
            bits = 1 << n
            for parent in parents:
                bits |= found[parent]
            found.append(bits)
        return found


@dataclass(frozen=True)
class Choice:
    """A commit to try next. `travel`: how long the bench needs to get there; `measure`: the measurement [s]; `future`:
    what is expected after it on a line of history [s], else None, and then `information` counts [bit]; `doubt`: how
    much longer it counts because a neighbor could not be told."""

    index: int
    travel: float
    measure: float
    future: float | None = None
    information: float = 1.0
    doubt: float = 1.0

    def score(self, travel: float | None = None) -> float:
        """Return what to choose the least of, where getting there takes `travel` seconds instead of the estimate."""
        seconds = ((self.travel if travel is None else travel) + self.measure) * self.doubt
        if self.future is not None:
            return seconds + self.future
        return seconds / self.information if self.information > 0 else math.inf


def choices(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[Choice]:
    """Return the commits worth trying next, the best first.

    `first(c)`: how long the bench needs from where it stands to commit c; `between(a, b)`: from a to b; `measure`: how
    long a measurement takes [s].
    """
    ways = _exact if suspects.linear and len(suspects.parents) <= MOST else _greedy
    found = ways(suspects, first, between, measure)
    return sorted(found, key=lambda c: (c.score(), c.index))


def halfway(suspects: Suspects) -> int | None:
    """Return the commit that git would try next: the one that leaves the smaller rest in the worse case."""
    before, count = suspects.ancestors(), len(suspects.parents)
    even = {n: min(before[n].bit_count(), count - before[n].bit_count()) for n in suspects.testable}
    return max(even, key=lambda n: (even[n], -n), default=None)


def _greedy(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[Choice]:
    before, total = suspects.ancestors(), sum(suspects.weight)
    found = []
    for n in sorted(suspects.testable):
        share = sum(w for k, w in enumerate(suspects.weight) if before[n] >> k & 1) / total if total else 0.0
        found.append(Choice(n, first(n), measure, information=entropy(share), doubt=_doubt(suspects, n)))
    return found


def entropy(share: float) -> float:
    """Return the information of a verdict that is bad with this probability [bit]."""
    return -sum(p * math.log2(p) for p in (share, 1.0 - share) if p > 0)


def _doubt(suspects: Suspects, n: int) -> float:
    """Return how much longer a trial counts beside one that could not be told: neighbors often fail together."""
    away = min((abs(n - k) for k in suspects.skipped), default=99)
    return 1.0 + 2.0 ** (1 - away)


def _exact(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[Choice]:
    """Return every first trial with the least expected time after it.

    The first bad commit is in (lo, hi]; a trial of m in between, from where the bench stands, leaves (lo, m] with the
    bench at m where it is bad, else (m, hi] with the bench at m again. So what is still to be done depends on lo, hi
    and at which of the two the bench stands.
    """
    table = _Intervals(suspects, between, measure)
    table.fill()
    last = len(suspects.parents) - 1
    return [
        Choice(n, first(n), measure, future=table.after(n, last), doubt=_doubt(suspects, n))
        for n in sorted(suspects.testable)
    ]


@dataclass
class _Intervals:
    """Least expected times over all intervals (lo, hi], lo from -1: index lo + 1. `_low`: the bench at lo, `_high`: at
    hi; `_low` is kept by columns."""

    suspects: Suspects
    between: Callable[[int, int], float]
    measure: float
    _low: list[list[float]] = field(default_factory=list)
    _high: list[list[float]] = field(default_factory=list)
    _sums: list[float] = field(default_factory=list)

    def fill(self) -> None:
        import numpy as np

        count = len(self.suspects.parents)
        weight = np.asarray(self.suspects.weight, dtype=float)
        sums = np.concatenate(([0.0], np.cumsum(weight)))
        several = np.concatenate(([0], np.cumsum(weight > 0)))
        cost = np.full((count, count), np.inf)
        for m in self.suspects.testable:
            for at in range(count):
                cost[at, m] = self.between(at, m) + self.measure if at != m else self.measure
        low, high = np.zeros((count, count + 1)), np.zeros((count + 1, count))  # low[hi, lo + 1], high[lo + 1, hi]
        for size in range(2, count + 1):
            for lo in range(-1, count - size):
                hi = lo + size
                if several[hi + 1] - several[lo + 1] < 2:
                    continue
                bad = (sums[lo + 2 : hi + 1] - sums[lo + 1]) / (sums[hi + 1] - sums[lo + 1])
                rest = bad * high[lo + 1, lo + 1 : hi] + (1 - bad) * low[hi, lo + 2 : hi + 1]
                for table, at, there in ((high, hi, (lo + 1, hi)), (low, lo, (hi, lo + 1))):
                    best = (cost[at, lo + 1 : hi] + rest).min() if at >= 0 else 0.0
                    table[there] = best if np.isfinite(best) else 0.0
        self._low, self._high, self._sums = low.tolist(), high.tolist(), sums.tolist()

    def after(self, m: int, last: int) -> float:
        """Return what is expected after a trial of `m` in the whole history up to `last` [s]."""
        total = self._sums[last + 1]
        bad = self._sums[m + 1] / total if total else 0.0
        return bad * self._high[0][m] + (1 - bad) * self._low[last][m + 1]
