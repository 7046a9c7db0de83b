"""How often somebody may ask: a bucket each that fills up again, by a clock that is passed in."""

from __future__ import annotations

from dataclasses import dataclass, field

KEPT = 10_000
"""Buckets that are kept at most: who has not asked for longest begins with a full one."""


@dataclass(slots=True)
class Rate:
    """So many requests a second each, and `burst` at once."""

    per_second: float
    burst: float
    _buckets: dict[str, tuple[float, float]] = field(default_factory=dict)

    def left(self, who: str, now: float) -> float:
        """Return how many requests somebody may make now, a part of one for what is to come."""
        had, then = self._buckets.get(who, (self.burst, now))
        return min(self.burst, had + max(0.0, now - then) * self.per_second)

    def taken(self, who: str, now: float) -> bool:
        """Count a request of somebody; return whether it may be answered."""
        left = self.left(who, now)
        self._buckets.pop(who, None)
        self._buckets[who] = (left - 1 if left >= 1 else left, now)
        if len(self._buckets) > KEPT:
            del self._buckets[next(iter(self._buckets))]
        return left >= 1
