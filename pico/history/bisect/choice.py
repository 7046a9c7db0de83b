"""Which configuration to try next, so that the one that broke something is found in the least time at the bench.

Pure: commits are numbers, parents before children, the last of them is the one known to be bad; costs are passed in.
Halving counts trials alike; here a trial costs what the bench needs to get there, and the measurement. On a line of
history the least expected time is found exactly (every order of trials, by intervals). Where branches meet, of the
trials with the most information per second that one is best after which always taking the most is quickest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

PROMISING = 12
"""Of how many trials it is worked out what is expected after them, where branches meet."""
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
class NextCommit:
    """A commit to try next. `travel`: how long the bench needs to get there; `measure`: the measurement; `future`: what
    is expected after it [s]; `doubt`: how much longer it counts because a neighbor could not be told."""

    index: int
    travel: float
    measure: float
    future: float
    doubt: float = 1.0

    def score(self, travel: float | None = None) -> float:
        """Return what is expected in all [s], where getting there takes `travel` instead of the estimate."""
        return ((self.travel if travel is None else travel) + self.measure) * self.doubt + self.future


def choices(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[NextCommit]:
    """Return the commits worth trying next, the best first; none whose result is certain, as it tells nothing.

    `first(c)`: how long the bench needs from where it stands to commit c; `between(a, b)`: from a to b; `measure`: how
    long a measurement takes [s].
    """
    suspects = replace(suspects, testable=_telling(suspects))
    ways = _exact if suspects.linear and len(suspects.parents) <= MOST else _promising
    found = ways(suspects, first, between, measure)
    return sorted(found, key=lambda c: (c.score(), c.index))


def _telling(suspects: Suspects) -> frozenset[int]:
    """Return the trials that may turn out either way; all of them where nothing tells one commit from another."""
    might = sum(1 << n for n, weight in enumerate(suspects.weight) if weight > 0)
    before = suspects.ancestors()
    return frozenset(n for n in suspects.testable if not might or 0 < before[n] & might < might)


def halfway(suspects: Suspects) -> int | None:
    """Return the commit that git would try next: the one that leaves the smaller rest in the worse case."""
    before, count = suspects.ancestors(), len(suspects.parents)
    even = {n: min(before[n].bit_count(), count - before[n].bit_count()) for n in suspects.testable}
    return max(even, key=lambda n: (even[n], -n), default=None)


def _promising(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[NextCommit]:
    """Return the trials with the most information per second, with what is expected after each where the trial with
    the most is always taken."""
    if not suspects.testable:
        return []
    greedy = _Greedy(suspects, between, measure)
    travel = {n: first(n) for n in greedy.trials}
    best = greedy.rated([travel[n] for n in greedy.trials])[:PROMISING]
    return [NextCommit(n, travel[n], measure, greedy.after(n), _doubt(suspects, n)) for n in best]


@dataclass
class _Greedy:
    """The search that takes the trial with the most information per second every time. Suspects are rows of flags."""

    suspects: Suspects
    between: Callable[[int, int], float]
    measure: float
    trials: list[int] = field(init=False)
    _known: dict[tuple[bytes, int], float] = field(default_factory=dict)
    _rows: dict[int, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        import numpy as np

        count, bits = len(self.suspects.parents), self.suspects.ancestors()
        self.trials = sorted(self.suspects.testable)
        flags = (np.frombuffer(bits[n].to_bytes(count // 8 + 1, "little"), np.uint8) for n in self.trials)
        self._bad = np.array([np.unpackbits(f, bitorder="little")[:count] for f in flags], dtype=bool)
        self._weight = np.asarray(self.suspects.weight, dtype=float)

    def rated(self, travel: Sequence[float]) -> list[int]:
        """Return the trials, that with the most information per second first, where all are suspects still."""
        import numpy as np

        rates = self._rates(np.ones(len(self._weight), dtype=bool), np.asarray(travel))
        return [self.trials[k] for k in np.argsort(-rates, kind="stable").tolist()]

    def after(self, trial: int) -> float:
        """Return what is expected after a first trial [s]."""
        import numpy as np

        return self._split(np.ones(len(self._weight), dtype=bool), self.trials.index(trial))

    def _split(self, left: Any, k: int) -> float:
        """Return what is expected after trial `k` where `left` are suspects [s]."""
        bad = left & self._bad[k]
        total = float(self._weight[left].sum())
        share = float(self._weight[bad].sum()) / total if total else 0.0
        return share * self._rest(bad, k) + (1 - share) * self._rest(left & ~bad, k)

    def _rest(self, left: Any, at: int) -> float:
        import numpy as np

        key = (np.packbits(left).tobytes(), at)
        if key not in self._known:
            rates = self._rates(left, self._row(at))
            k = int(rates.argmax())
            more = rates[k] > 0 and int((self._weight[left] > 0).sum()) > 1
            self._known[key] = float(self._row(at)[k]) + self.measure + self._split(left, k) if more else 0.0
        return self._known[key]

    def _rates(self, left: Any, travel: Any) -> Any:
        """Return the information of each trial per second [bit/s]; none of one that is no suspect any more."""
        import numpy as np

        weight = self._weight * left
        total = weight.sum()
        share = self._bad @ weight / total if total else np.zeros(len(self.trials))
        share = np.clip(share, 0.0, 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            bits = -np.nan_to_num(share * np.log2(share)) - np.nan_to_num((1 - share) * np.log2(1 - share))
        return bits * left[self.trials] / np.maximum(travel + self.measure, 1e-6)

    def _row(self, at: int) -> Any:
        import numpy as np

        if at not in self._rows:
            here = self.trials[at]
            self._rows[at] = np.array([self.between(here, n) if n != here else 0.0 for n in self.trials])
        return self._rows[at]


def _doubt(suspects: Suspects, n: int) -> float:
    """Return how much longer a trial counts beside one that could not be told: neighbors often fail together."""
    away = min((abs(n - k) for k in suspects.skipped), default=99)
    return 1.0 + 2.0 ** (1 - away)


def _exact(
    suspects: Suspects, first: Callable[[int], float], between: Callable[[int, int], float], measure: float
) -> list[NextCommit]:
    """Return every first trial with the least expected time after it.

    The first bad commit is in (lo, hi]; a trial of m in between, from where the bench stands, leaves (lo, m] with the
    bench at m where it is bad, else (m, hi] with the bench at m again. So what is still to be done depends on lo, hi
    and at which of the two the bench stands.
    """
    table = _Intervals(suspects, between, measure)
    table.fill()
    last = len(suspects.parents) - 1
    return [
        NextCommit(n, first(n), measure, table.after(n, last), _doubt(suspects, n)) for n in sorted(suspects.testable)
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
