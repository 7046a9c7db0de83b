"""A second search for several causes, for changes that the first leaves unexplained or explains by one part twice.

Explanations grow by one cause at a time here, too, but are compared by squeezed residuals (see `refining`): one that
explains most readings exactly and leaves some is better than one that explains all of them a little. So each dark
detector may first be explained by itself, and what else dims its light is found beside that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pico.diagnosis.explanations import Changed, Explanation
from pico.diagnosis.refining import residuals, squeezed
from pico.diagnosis.weighing import Weighed, at_size

MOST = 5
"""Causes that are looked for, at most."""
BESIDE, REFINED = 3, 5
"""How many explanations are followed at a time, and how many with one cause more are refined, the best."""
SHARE = 0.1
"""By which share a change may differ from what is known of each cause alone."""
SAME = 1.0
"""Standard deviations up to which two causes do the same."""
PER_WAY = 1.5
"""What a size that is free costs in the logarithm of the odds."""


@dataclass(frozen=True, eq=False)
class Deepening:
    """A search over explanations of `what`; `lowest`: the least change that each reading can show; `refine`: fits an
    explanation by the whole model; `enough`: whether it ends the search."""

    what: Changed
    lowest: Any
    refine: Callable[[Explanation], Explanation]
    enough: Callable[[Explanation], bool]

    def grow(self, beam: Sequence[Explanation]) -> None:
        """Refine explanations with more and more causes than some until one is enough."""
        while beam := [one for one in beam if len(one.numbers) < MOST]:
            fits = dict[tuple[int, ...], Explanation]()
            for wider in self._wider(beam):
                one = self.refine(wider)
                fits[one.key] = one
                if self.enough(one):
                    return
            beam = sorted(fits.values(), key=self.cost)[:BESIDE]

    def cost(self, one: Explanation) -> float:
        """Return the negative logarithm of the odds of an explanation, its residuals squeezed."""
        noise = np.sqrt(np.diagonal(self.what.usual) + (self.what.exact * self.what.d) ** 2)
        return float(self._cost(residuals(self.what, self.lowest, one.whole, noise))) + sum(
            self._dear(n, f.size) for n, f in zip(one.numbers, one.found, strict=True)
        )

    def _cost(self, off: Any) -> Any:
        return 0.5 * (squeezed(off) ** 2).sum(axis=-1)

    def _dear(self, number: int, size: Any) -> float:
        """Return what a cause of a size costs beside what it leaves."""
        ways = self.what.responses[number].cause.ways
        rare = sum((float(z) / (3 * w.fault)) ** 2 for w, z in zip(ways, size, strict=True))
        return 0.5 * rare + PER_WAY * len(ways) - self.what.prior[number]

    def _wider(self, beam: Sequence[Explanation]) -> list[Explanation]:
        """Return the best explanations with one cause more than some, of those that do the same the first."""
        least = np.diagonal(self.what.usual) + (self.what.exact * self.what.d) ** 2
        found: list[tuple[float, int, Explanation, int, Any]] = []
        for parent in beam:
            noise = np.sqrt(least + (SHARE * (self.what.d - parent.whole)) ** 2)
            dear = sum(self._dear(n, f.size) for n, f in zip(parent.numbers, parent.found, strict=True))
            for n, response in enumerate(self.what.responses):
                if n in parent.numbers:
                    continue
                moved = np.maximum(np.where(np.isnan(response.moved), -np.inf, response.moved), -40.0)
                costs = self._cost(residuals(self.what, self.lowest, parent.whole + moved, noise))
                for k in self._sizes(response.sizes, costs, response.cause.ways):
                    whole = np.maximum(parent.whole + moved[k], np.maximum(self.lowest, -40.0))
                    cost = float(costs[k]) + dear + self._dear(n, response.sizes[k])
                    found.append((cost, n, parent.beyond(n, self._at(n, response.sizes[k])), len(found), whole))
        return self._unlike(sorted(found, key=lambda f: (f[0], f[3])), np.sqrt(least))

    def _sizes(self, sizes: Any, costs: Any, ways: Sequence[Any]) -> list[int]:
        """Return the number of the best size of a cause."""
        allowed = np.all([sizes[:, n] >= 0 for n, w in enumerate(ways) if w.one_sided] or [np.isfinite(costs)], axis=0)
        allowed &= sizes.any(axis=1) if len(ways) else True
        return [int(np.where(allowed, costs, np.inf).argmin())] if allowed.any() else []

    def _unlike(self, found: Sequence[tuple[float, int, Explanation, int, Any]], noise: Any) -> list[Explanation]:
        """Return the first explanations that differ in what they do."""
        chosen: list[tuple[Explanation, Any]] = []
        for _, _, one, _, whole in found:
            if len(chosen) == REFINED:
                break
            if any(one.key == c.key or (np.abs(whole - w) < SAME * noise).all() for c, w in chosen):
                continue
            chosen.append((one, whole))
        return [one for one, _ in chosen]

    def _at(self, number: int, size: Any) -> Weighed:
        """Return a cause at a size, as it is alone."""
        response, empty = self.what.responses[number], Explanation()
        near = at_size(
            response.cause, size, response.at(size), response.slope_at(size), self.what.spread(empty), self.what.d
        )
        return replace(near, size=size)
