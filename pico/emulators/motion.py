"""How an emulated axis moves: at constant speed, by the clock of the world behind it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Motion:
    """From a position to another one, in the axis's unit, since `began` [s], at `speed` [unit/s]; it gets stuck at
    `stuck` where that is on its way."""

    begin: float
    end: float
    began: float
    speed: float
    stuck: float | None = None

    @property
    def reached(self) -> float:
        """Where it comes to rest."""
        low, high = sorted((self.begin, self.end))
        return self.end if self.stuck is None or not low <= self.stuck <= high else self.stuck

    def at(self, now: float) -> float:
        """Return where it is."""
        way = max(0.0, now - self.began) * self.speed
        left = self.reached - self.begin
        return self.reached if way >= abs(left) else self.begin + (way if left > 0 else -way)

    def ended(self, now: float) -> bool:
        """Return whether it is at rest."""
        return self.at(now) == self.reached
