"""Several causes together as an explanation of what changed: their sizes fitted by the whole ray model, and the odds.

Near the sizes z of its causes an explanation gives the changes m(z), with derivatives J (n, k); by Bayes' theorem

    d - m(z) + J z ~ N(0, N + J S^2 J'),    N = C + MODEL^2 diag(d^2)

with C, d, and S as in `pico.diagnosis.suspects`. The sizes are bettered by the method of Gauss and Newton; J is what
each cause does alone, traced anew where causes together do not do the sum of that, and corrected after Broyden.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from pico.diagnosis.modelled import Modelled
from pico.diagnosis.responses import Response
from pico.diagnosis.weighing import Weighed, normal, one_sided, prior_at, share_of

ROUNDS = 7
"""How often all causes together are modelled anew, at most."""
HOPELESS = 25.0
"""By how much less likely than another an explanation may be after two rounds to be bettered further."""
HALVED = 3
"""How often the size of a cause is halved that does worse than nothing."""
NEAR = 0.5
"""The step of a size, in its standard deviations, below which it is not bettered further."""
TOGETHER = 2.0
"""Standard deviations by which causes may differ from the sum of what each does before derivatives are traced anew."""
PLAIN = ("loss", "gain", "power", "dark")
"""Ways that do the same to a reading whatever else happens."""


@dataclass(frozen=True, eq=False)
class Changed:
    """What is to be explained: changes `d` (n,) of covariance `usual` (n, n) when nothing unusual happened, the
    `responses` of causes with the logarithm of the `prior` of each, `calm` that of nothing. `exact`: the share by which
    a change may differ from what the whole ray model gives; `rough`: from what is known of one cause alone."""

    d: Any
    usual: Any
    responses: tuple[Response, ...]
    prior: tuple[float, ...]
    calm: float
    exact: float
    rough: float

    def only(self, numbers: Sequence[int]) -> Changed:
        """Return the same of some of the changes."""
        usual = self.usual[np.ix_(numbers, numbers)]
        return replace(self, d=self.d[numbers], usual=usual, responses=tuple(r.only(numbers) for r in self.responses))

    def noise(self, one: Explanation) -> Any:
        """Return the covariance (n, n) of changes whose causes are known in size."""
        share = self.exact**2 * self.d**2
        if not one.exact:
            share = share + self.rough**2 * (self.d - one.whole) ** 2
        return self.usual + np.diag(share)

    def spread(self, one: Explanation) -> Any:
        """Return the covariance (n, n) of changes with the causes of an explanation set aside."""
        whole = self.noise(one)
        for cause in one.found:
            whole = whole + (cause.slope * cause.prior**2) @ cause.slope.T
        return whole

    def left(self, one: Explanation) -> Any:
        """Return what is left (n,) of the changes with the causes of an explanation set aside, their sizes free."""
        return self.d - one.whole + sum((c.slope @ c.size for c in one.found), np.zeros(len(self.d)))

    def unexplained(self, one: Explanation) -> Any:
        """Return what an explanation leaves of each change (n,), in standard deviations."""
        return (self.d - one.whole) / np.sqrt(np.diagonal(self.noise(one)))


@dataclass(frozen=True, eq=False)
class Explanation:
    """Causes by their `numbers` among the responses, each `found` at its size, what they do together beside the sum of
    what each does, `beside` (n,), and the logarithm of the `odds`. `exact`: the whole model was asked."""

    numbers: tuple[int, ...] = ()
    found: tuple[Weighed, ...] = ()
    beside: Any = 0.0
    odds: float = 0.0
    exact: bool = False

    @property
    def key(self) -> tuple[int, ...]:
        """What tells it from others."""
        return tuple(sorted(self.numbers))

    @property
    def whole(self) -> Any:
        """What the causes do together (n,)."""
        return sum((f.moved for f in self.found), 0.0) + self.beside

    def without(self, number: int) -> Explanation:
        """Return the same without one of its causes, to be fitted anew."""
        left = [n for n in range(len(self.numbers)) if n != number]
        return Explanation(tuple(self.numbers[n] for n in left), tuple(self.found[n] for n in left), self.beside)

    def beyond(self, number: int, found: Weighed) -> Explanation:
        """Return the same with one cause more, to be fitted anew."""
        return Explanation((*self.numbers, number), (*self.found, found), self.beside)


def judged(what: Changed, one: Explanation) -> Explanation:
    """Return an explanation with its odds."""
    odds = normal(what.spread(one), what.left(one)) + (0.0 if one.numbers else what.calm)
    if not one.numbers:
        return replace(one, odds=odds)
    covariance = _covariance(what, one)
    sizes = np.concatenate(_sizes(what, one))
    ways = [way for n in one.numbers for way in what.responses[n].cause.ways]
    for n, way in enumerate(ways):
        if way.one_sided:
            odds += one_sided(float(sizes[n]), float(covariance[n, n]))
    odds += sum(share_of(f, what.responses[n].cause) for n, f in zip(one.numbers, one.found, strict=True))
    found = tuple(replace(f, spread=own) for f, own in zip(one.found, _blocks(one, covariance), strict=True))
    return replace(one, found=found, odds=odds + sum(what.prior[n] for n in one.numbers))


def roughly(what: Changed, one: Explanation) -> Explanation:
    """Return an explanation with its sizes bettered by what each cause does alone, without asking the model."""
    best = judged(what, one)
    for _ in range(2):
        sizes = _bounded(what, best, _sizes(what, best))
        now = judged(what, _at(what, best, sizes, best.beside))
        if now.odds <= best.odds:
            break
        best = now
    return best


def fitted(what: Changed, model: Modelled, one: Explanation, least: float = -math.inf) -> Explanation:
    """Return an explanation with its causes at the sizes that explain most together, by the whole model; roughly if its
    odds do not come near the `least` of interest."""
    if not one.numbers:
        return judged(what, Explanation(exact=True))
    best = _begun(what, model, one)
    lowest, part, traced = _misfit(what, best), 1.0, False
    for number in range(ROUNDS):
        if number == 3 and bound_odds(what, best).odds < least - HOPELESS:
            break
        if (number > 1 or part < 1) and not traced and _apart(what, best):
            best, traced = trace_slopes(what, model, best), True
        to = _bounded(what, best, _sizes(what, best))
        step = [part * (a - f.size) for a, f in zip(to, best.found, strict=True)]
        if all((np.abs(s) <= NEAR * _sigma(f)).all() for s, f in zip(step, judged(what, best).found, strict=True)):
            break
        now = evaluate(what, model, best, [f.size + s for f, s in zip(best.found, step, strict=True)])
        off = _misfit(what, now)
        if off < lowest - 1e-6:
            traced = traced and off > lowest / 2
            best, lowest, part = _corrected(what, best, now, step), off, min(1.0, 3 * part)
        else:
            part /= 4
    return bound_odds(what, best)


def _begun(what: Changed, model: Modelled, one: Explanation) -> Explanation:
    """Return an explanation by the whole model at its sizes; that of its last cause halved as long as it does worse
    than nothing: from where all light is lost no derivative leads back."""
    rest = replace(one, found=one.found[:-1])
    without, sizes = _misfit(what, replace(rest, exact=True)), [f.size for f in one.found]
    best = evaluate(what, model, one, sizes)
    for _ in range(HALVED):
        if _misfit(what, best) <= without or not len(sizes[-1]):
            break
        sizes = [*sizes[:-1], sizes[-1] / 2]
        best = evaluate(what, model, one, sizes)
    return best


def bound_odds(what: Changed, one: Explanation) -> Explanation:
    """Return an explanation with its odds as far as they are sure: by what it leaves at its sizes, not by what its
    derivatives say that better ones would leave."""
    left, found = what.left(one), judged(what, one)
    least = float(left @ np.linalg.solve(what.spread(one), left))
    return replace(found, odds=found.odds - 0.5 * max(0.0, _misfit(what, one) - least))


def _sigma(found: Weighed) -> Any:
    return np.sqrt(np.maximum(0.0, np.diagonal(found.spread))) + 1e-12


def _at(what: Changed, one: Explanation, sizes: Sequence[Any], beside: Any) -> Explanation:
    """Return an explanation at other sizes, by what each cause does alone."""
    responses = [what.responses[n] for n in one.numbers]
    found = tuple(
        replace(f, size=z, moved=_known(r.at(z)), slope=_known(r.slope_at(z)), prior=prior_at(r.cause, z))
        for f, r, z in zip(one.found, responses, sizes, strict=True)
    )
    return replace(one, found=found, beside=beside)


def evaluate(what: Changed, model: Modelled, one: Explanation, sizes: Sequence[Any]) -> Explanation:
    """Return an explanation at other sizes, by the whole model, with the derivatives of each cause alone."""
    responses = [what.responses[n] for n in one.numbers]
    alone = _at(what, one, sizes, 0.0)
    steps = [s for r, size in zip(responses, sizes, strict=True) for s in r.steps(size)]
    summed = alone.whole
    whole = model.changes(steps) if steps else np.zeros(len(what.d))
    whole = np.where(np.isfinite(whole), whole, summed)
    for response, own in zip(responses, alone.found, strict=True):
        if not response.cause.ways:  # light that is kept back, which is no change of the model
            whole = np.minimum(whole, np.where(own.moved < 0, own.moved, whole))
    return replace(alone, beside=whole - summed, exact=True)


def _apart(what: Changed, one: Explanation) -> bool:
    """Return whether causes together do not do the sum of what each is taken to do."""
    noise = np.sqrt(np.diagonal(what.noise(one)))
    return bool((np.abs(one.beside) > TOGETHER * noise).any())


def trace_slopes(what: Changed, model: Modelled, one: Explanation) -> Explanation:
    """Return an explanation with the derivatives of the whole model."""
    responses, found = [what.responses[n] for n in one.numbers], []
    sizes = [f.size for f in one.found]
    for k, (response, own) in enumerate(zip(responses, one.found, strict=True)):
        others = [s for m, r in enumerate(responses) if m != k for s in r.steps(sizes[m])]
        slope = own.slope.copy()
        for n, way in enumerate(response.cause.ways):
            if way.what in PLAIN:
                continue
            by = way.step / 4 * (1.0 if own.size[n] >= 0 else -1.0)
            there = model.changes([*others, *response.steps(own.size + by * np.eye(len(own.size))[n])])
            column = (there - one.whole) / by
            slope[:, n] = np.where(np.isfinite(column), column, slope[:, n])
        found.append(replace(own, slope=slope))
    return replace(one, found=tuple(found))


def _corrected(what: Changed, one: Explanation, now: Explanation, step: Sequence[Any]) -> Explanation:
    """Return an explanation with derivatives as those of the one before differ from what each cause does alone, and
    corrected by what the step between them did."""
    alone = [_known(what.responses[n].slope_at(f.size)) for n, f in zip(one.numbers, one.found, strict=True)]
    slopes = [n.slope + b.slope - a for n, b, a in zip(now.found, one.found, alone, strict=True)]
    scale = [np.where(f.prior > 0, f.prior, 1.0) for f in one.found]
    unit = [s / p for s, p in zip(step, scale, strict=True)]
    if length := sum(float(u @ u) for u in unit):
        middle = [(n + b.slope) / 2 for n, b in zip(slopes, one.found, strict=True)]
        off = now.whole - one.whole - sum((m @ s for m, s in zip(middle, step, strict=True)), 0.0)
        slopes = [n + np.outer(off, u / p) / length for n, u, p in zip(slopes, unit, scale, strict=True)]
    return replace(now, found=tuple(replace(f, slope=n) for f, n in zip(now.found, slopes, strict=True)))


def _misfit(what: Changed, one: Explanation) -> float:
    """Return how far an explanation is from what changed, in variances, with how rare the sizes of its causes are."""
    left, noise = what.d - one.whole, what.noise(one)
    rare = sum(float(np.sum((f.size / np.where(f.prior > 0, f.prior, 1.0)) ** 2)) for f in one.found)
    return float(left @ np.linalg.solve(noise, left)) + rare


def _known(changes: Any) -> Any:
    """Return changes, 0 where they are not known."""
    return np.where(np.isfinite(changes), changes, 0.0)


def _joined(one: Explanation) -> tuple[Any, Any]:
    """Return the derivatives (n, k) by the sizes of all causes, and the prior covariance (k, k) of these."""
    slope = np.concatenate([f.slope for f in one.found], axis=1)
    return slope, np.diag(np.concatenate([f.prior for f in one.found]) ** 2)


def _sizes(what: Changed, one: Explanation) -> list[Any]:
    """Return the sizes of the causes of an explanation that explain most together, by their derivatives."""
    slope, prior = _joined(one)
    size = prior @ slope.T @ np.linalg.solve(what.noise(one) + slope @ prior @ slope.T, what.left(one))
    ends = np.cumsum([0, *(f.slope.shape[1] for f in one.found)])
    return [size[a:b] for a, b in pairwise(ends)]


def _bounded(what: Changed, one: Explanation, sizes: Sequence[Any]) -> list[Any]:
    """Return sizes of which those that only grow are not negative."""
    found = []
    for n, size in zip(one.numbers, sizes, strict=True):
        least = [0.0 if w.one_sided else -math.inf for w in what.responses[n].cause.ways]
        found.append(np.maximum(size, least) if least else size)
    return found


def _covariance(what: Changed, one: Explanation) -> Any:
    """Return the covariance (k, k) of the sizes of all causes of an explanation."""
    slope, prior = _joined(one)
    whole = what.noise(one) + slope @ prior @ slope.T
    return prior - prior @ slope.T @ np.linalg.solve(whole, slope @ prior)


def _blocks(one: Explanation, covariance: Any) -> list[Any]:
    ends = np.cumsum([0, *(len(f.size) for f in one.found)])
    return [covariance[a:b, a:b] for a, b in pairwise(ends)]
