"""Several causes at once: explanations grow by one cause at a time, the likeliest are fitted by the whole ray model;
of each cause it is asked then whether it is needed and whether another would do, until nothing explains more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import numpy as np

from pico.diagnosis.deepening import Deepening
from pico.diagnosis.explanations import PLAIN, Changed, Explanation, evaluate, fitted, roughly
from pico.diagnosis.modelled import Modelled
from pico.diagnosis.refining import refine
from pico.diagnosis.weighing import modes

MOST = 6
"""Causes that are looked for, at most."""
BESIDE = 3
"""How many explanations are followed at a time."""
TRIED = 4
"""How many explanations with one cause more are fitted by the whole model, the likeliest."""
BETTER = 0.5
"""By how much the logarithm of the odds must grow for one explanation to replace another."""
CLOSE = 3.0
"""Up to which difference of the logarithm of the odds another explanation is as good as the best."""
RARER, LEFT = 10.0, 4.0
"""Up to which difference of it one of as many causes is, if it leaves of all changes no more than so many variances."""
UNSURE = 4.0
"""By how much less likely an explanation may look before it is fitted by the whole model."""
SCREENED, RIVALS = 30, 8
"""How many alternatives to each cause the whole model is asked of at the sizes that they look like, the likeliest; and
how many are fitted by it, those that are nearest then."""
STARTS, NEIGHBOR, OTHERS = 6, 6.0, 2
"""Of how many explanations at most it is asked whether a cause less or another one is better; by how much less likely
these may be than the best; and how many alternatives to each cause are tried then."""
SEARCHED, FURTHER, DEEPEST, COMPARED = 120, 200, 420, 260
"""How often all quantities are asked of the ray model before the search ends; before it ends if the causes leave
something; before a deeper search ends then; and before half as many alternatives are compared."""
FARTHEST = 600
"""The same before alternatives to what a deeper search found are no longer refined."""
REFINED, DEEPER = 3, 3
"""How many explanations a deeper search begins with; how many alternatives to each of its causes that leave something
are refined, and not only one."""
ALIKE = 1.0
"""Standard deviations up to which two causes that dim light dim the same."""
MISFIT = 4.0
"""Standard deviations from which what is left of a change calls for another cause."""


@dataclass(eq=False)
class Search:
    """A search for what explains changes. `pool`: all explanations that were fitted by the whole model, by key."""

    what: Changed
    model: Modelled
    pool: dict[tuple[int, ...], Explanation] = field(default_factory=dict)
    _tried: set[tuple[tuple[int, tuple[int, ...]], ...]] = field(default_factory=set)
    _first: int = 0
    _deep: bool = False

    def __post_init__(self) -> None:
        self._first = self.model.asked

    @property
    def _asked(self) -> float:
        """How often all quantities were asked of the ray model."""
        return (self.model.asked - self._first) / len(self.what.d)

    def best(self) -> Explanation:
        """Return the likeliest explanation: without causes where nothing unusual is the likeliest."""
        self._grown([self._fit(Explanation())])
        self._better()
        if self._misses(self._first_of()):
            self._deep = True
            for one in self._by_cost()[:REFINED]:
                self._refine(one)
            self._better()
        if self._misses(self._first_of()):
            self._deepening().grow([Explanation(), *self._by_cost()[:REFINED]])
            self._better()
        return self._needed(self._first_of())

    def _needed(self, one: Explanation) -> Explanation:
        """Return an explanation without those of its causes that are not needed: those that do nothing which would
        show, and, as a search that was cut short did not ask it, any other."""
        order = sorted(range(len(one.numbers)), key=lambda k: not self._idle(one, k))
        for cause in [one.numbers[k] for k in order]:
            number = one.numbers.index(cause)
            idle = self._idle(one, number)
            if idle or SEARCHED < self._asked < DEEPEST:
                self._refine(fewer := one.without(number))
                fewer = self.pool[fewer.key]
                one = fewer if fewer.odds > one.odds - (CLOSE if idle else 0.0) else one
        return one

    def _first_of(self) -> Explanation:
        return max(self.pool.values(), key=lambda one: one.odds)

    def _by_cost(self) -> list[Explanation]:
        return sorted((one for one in self.pool.values() if one.numbers), key=self._deepening().cost)

    def _deepening(self) -> Deepening:
        return Deepening(self.what, self.model.lowest, self._refine, self._enough)

    def _enough(self, one: Explanation) -> bool:
        """Return whether a deeper search ends: with an explanation that leaves nothing, or with its last question."""
        return self._asked > DEEPEST or not self._misses(one)

    def _refine(self, one: Explanation) -> Explanation:
        """Return an explanation at sizes that a descent from its own leads to, if these are better than known ones."""
        found = refine(self.what, self.model, one)
        known = self.pool.get(one.key)
        if known is None or found.odds > known.odds:
            self.pool[one.key] = found
        return found

    def _better(self) -> None:
        """Replace causes of the likeliest explanations, or leave them out, as long as that makes them likelier."""
        done: set[tuple[int, ...]] = set()
        for _ in range(STARTS):
            first = max(self.pool.values(), key=lambda one: one.odds)
            near = [one for one in self.pool.values() if one.key not in done and one.odds > first.odds - NEIGHBOR]
            if not near or self._spent(first):
                break
            start = max(near, key=lambda one: one.odds)
            done.add(start.key)
            if (other := self._bettered(start)) is not None and other.odds > first.odds:
                self._grown([other])

    def close(self, best: Explanation) -> tuple[Explanation, ...]:
        """Return the explanations that are as good as the best, with one of its causes replaced or otherwise, that
        first."""
        for number in range(len(best.numbers)):
            rest = best.without(number)
            likely = sorted(self._wider(rest, but=best.numbers, most=None), key=lambda one: -one.odds)
            likely = [one for one in likely if one.odds > likely[0].odds - RARER - UNSURE]
            traced = [one for one in likely if not self._plain(one.numbers[-1])]
            nearest = sorted(self._by_part(traced)[:SCREENED], key=self._whole_cost)
            traced = self._by_part(
                [one for k, one in enumerate(nearest) if one.key not in {o.key for o in nearest[:k]}]
            )
            traced = traced[: RIVALS if self._deep or self._asked < COMPARED else RIVALS // 2]
            spare = DEEPER if self._deep else 1
            for one in [*traced, *(one for one in likely if self._plain(one.numbers[-1]))]:
                rival = self._fit(one, best.odds, again=True)
                if spare and self._misses(rival) and self._asked < (FARTHEST if self._deep else DEEPEST):
                    self._refine(rival)
                    spare -= 1
        others = [one for one in self.pool.values() if one.key != best.key and self._as_good(one, best)]
        return best, *sorted(others, key=lambda one: -one.odds)

    def _by_part(self, ones: Sequence[Explanation]) -> list[Explanation]:
        """Return explanations in their order, the first of each part that has their last cause before all others."""
        parts = [self.what.responses[one.numbers[-1]].cause.part for one in ones]
        order = sorted(range(len(ones)), key=lambda k: parts[k] in parts[:k])
        return [ones[k] for k in order]

    def _whole_cost(self, one: Explanation) -> float:
        """Return what an explanation costs by the whole model at its sizes, see `Deepening`."""
        return self._deepening().cost(evaluate(self.what, self.model, one, [f.size for f in one.found]))

    def _as_good(self, one: Explanation, best: Explanation) -> bool:
        """Return whether an explanation is as good as the best: as likely; or of as many causes and leaving as little,
        though of sizes that are rarer, which no reading tells."""
        if one.odds > best.odds - CLOSE:
            return True
        if len(one.numbers) != len(best.numbers) or one.odds < best.odds - RARER:
            return False
        off = [float(self.what.unexplained(each) @ self.what.unexplained(each)) for each in (one, best)]
        return off[0] < off[1] + LEFT

    def _plain(self, number: int) -> bool:
        """Return whether a cause needs no light traced."""
        return all(w.what in PLAIN for w in self.what.responses[number].cause.ways)

    def _fit(self, one: Explanation, least: float = -math.inf, again: bool = False) -> Explanation:
        """Return an explanation fitted by the whole model, or the better one of the same causes. `again`: fitted anew
        if it looks better than a known one."""
        sides = [tuple(np.sign(f.size).astype(int).tolist()) for f in one.found]
        tried = tuple(sorted(zip(one.numbers, sides, strict=True)))
        known = self.pool.get(one.key)
        if known is None or tried not in self._tried or (again and one.odds > known.odds + UNSURE):
            self._tried.add(tried)
            found = fitted(self.what, self.model, one, least)
            if known is None or found.odds > known.odds:
                self.pool[one.key] = known = found
        return known

    def _elsewhere(self, one: Explanation, known: Explanation) -> bool:
        """Return whether an explanation has a cause on the other side of nothing than one that is known."""
        sizes = dict(zip(known.numbers, known.found, strict=True))
        return any(f.size @ sizes[n].size < 0 for n, f in zip(one.numbers, one.found, strict=True) if len(f.size))

    def _grown(self, beam: Sequence[Explanation]) -> None:
        """Fit explanations that have the causes of some and more, as long as that makes them likelier."""
        best, patient = max(beam, key=lambda one: one.odds), True
        while beam and len(beam[0].numbers) < MOST and not self._spent(best):
            wider, fits = self._likely([one for each in beam for one in self._wider(each)]), list[Explanation]()
            for one in wider:
                fits.append(self._fit(one, max((f.odds for f in fits), default=-math.inf)))
            beam = sorted({f.key: f for f in fits}.values(), key=lambda one: -one.odds)[:BESIDE]
            if beam and beam[0].odds > best.odds:
                best, patient = beam[0], True
            elif not patient or not self._misses(best):
                break
            else:
                patient = False

    def _spent(self, best: Explanation) -> bool:
        """Return whether the ray model was asked as often as the search may."""
        return self._asked > (FURTHER if self._misses(best) else SEARCHED)

    def _misses(self, one: Explanation) -> bool:
        return bool((np.abs(self.what.unexplained(one)) > MISFIT).any())

    def _likely(self, wider: Sequence[Explanation], most: int = TRIED) -> list[Explanation]:
        """Return the likeliest explanations, each set of causes at two sizes at most; of those of which the last cause
        only dims light, and dims the same, the first."""
        found: dict[tuple[int, ...], list[Explanation]] = {}
        dimmed: list[tuple[tuple[int, ...], Any]] = []
        noise = np.sqrt(np.diagonal(self.what.usual))
        for one in sorted(wider, key=lambda one: -one.odds):
            if self._plain(one.numbers[-1]) and one.key not in found:
                own = one.numbers[:-1], one.found[-1].moved / noise
                if any(own[0] == rest and np.abs(own[1] - moved).max() < ALIKE for rest, moved in dimmed):
                    continue
                dimmed.append(own)
            same = found.get(one.key, [])
            if len(same) < 2 and (same or len(found) < most) and (not same or self._elsewhere(one, same[0])):
                found[one.key] = [*same, one]
        return [one for same in found.values() for one in same]

    def _wider(self, one: Explanation, but: Sequence[int] = (), most: int | None = 4 * TRIED) -> Iterator[Explanation]:
        """Yield the likeliest explanations with one cause more, none of some, by what is known of each cause alone."""
        what = self.what
        rough = Explanation(one.numbers, one.found, one.beside)
        spread, left = what.spread(rough), what.left(rough)
        found = []
        for n, response in enumerate(what.responses):
            if n not in one.numbers and n not in but:
                found += [(f.evidence + what.prior[n], n, f) for f in modes(response, spread, left)]
        found = [f for f in found if math.isfinite(f[0])]
        for _, n, cause in sorted(found, key=lambda f: -f[0])[:most]:
            yield roughly(what, rough.beyond(n, cause))

    def _bettered(self, best: Explanation) -> Explanation | None:
        """Return a likelier explanation with a cause less or another one; None if there is none."""
        for number in range(len(best.numbers)):
            rest = best.without(number)
            for less in (rest, *self._again(rest)):
                if (fewer := self._fit(less, best.odds)).odds > best.odds:
                    return fewer
            for one in self._likely([*self._wider(rest, but=best.numbers)], OTHERS):
                if (other := self._fit(one, best.odds)).odds > best.odds + BETTER:
                    return other
        for one in self._merged(best):
            if (other := self._fit(one, best.odds)).odds > best.odds:
                return other
        return None

    def _idle(self, one: Explanation, number: int) -> bool:
        """Return whether one of the causes of an explanation does nothing that would show."""
        noise = np.sqrt(np.diagonal(self.what.usual))
        return len(one.found) > 1 and bool((np.abs(one.found[number].moved) < noise).all())

    def _merged(self, best: Explanation) -> Iterator[Explanation]:
        """Yield explanations with one cause that dims light in place of two."""
        plain = [k for k, number in enumerate(best.numbers) if self._plain(number)]
        for a, b in combinations(plain, 2):
            rest = best.without(b).without(a)
            wider = sorted(self._wider(rest, but=best.numbers, most=None), key=lambda one: -one.odds)
            yield from [one for one in wider if self._plain(one.numbers[-1])][:OTHERS]

    def _again(self, one: Explanation) -> list[Explanation]:
        """Return an explanation with one of its causes at the size that it would have if it came last: beside a cause
        that did not happen it may have gone astray."""
        what, found = self.what, list[Explanation]()
        for k, number in enumerate(one.numbers):
            if self._plain(number) or len(one.numbers) == 1:
                continue
            rest = one.without(k)
            seen = modes(what.responses[number], what.spread(rest), what.left(rest))
            found += [roughly(what, rest.beyond(number, f)) for f in seen if math.isfinite(f.evidence)]
        return sorted(found, key=lambda again: -again.odds)[:OTHERS]
