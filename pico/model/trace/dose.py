"""The light that a sample has had, and may have."""

from __future__ import annotations

from pico.model.record import record


@record
class Dose:
    """What the `sample` in a `component` has had [mJ], of a `budget` where it has one, and the `power` that falls on it
    now [mW]. `at_least`: it had that much or more, for what the bench had counted was gone, or light fell on it that
    was not followed to its end. `unknown`: why more than `power` may fall on it now."""

    sample: str
    component: str
    spent: float
    budget: float | None = None
    power: float = 0.0
    at_least: bool | None = None
    unknown: str | None = None

    @property
    def left(self) -> float | None:
        """What it may have still [mJ]; None without a budget."""
        return None if self.budget is None else max(0.0, self.budget - self.spent)

    @property
    def said(self) -> str:
        """`WSe2-041 in holder1 has had 4.8 of its 5 mJ of light`."""
        of = f" of its {self.budget:g} mJ" if self.budget is not None else " mJ"
        least = "at least " if self.at_least else ""
        return f"{self.sample} in {self.component} has had {least}{self.spent:.4g}{of} of light"
