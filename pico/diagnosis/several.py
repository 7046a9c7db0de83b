"""Several causes at once: the likeliest is found, what it explains is set aside with its uncertainty, and the rest is
weighed again, until nothing unusual is left. Then each cause is weighed anew with the others set aside, and replaced or
dropped where that explains more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from pico.diagnosis.modelled import Modelled
from pico.diagnosis.responses import Response
from pico.diagnosis.weighing import Weighed, normal, one_sided, share_of, weighed

MOST = 6
"""Causes that are looked for, at most."""
BESIDE = 3
"""How many explanations are followed at a time."""
BETTER = 1.0
"""By how much the logarithm of the evidence must grow for a cause to replace another."""
ROUNDS, ANEW = 3, 5
"""How often all causes together are modelled anew."""


@dataclass(frozen=True, eq=False)
class Changed:
    """What is to be explained: changes `d` (n,) of covariance `usual` (n, n) when nothing unusual happened, the
    `responses` of causes with the logarithm of the `prior` of each, `calm` that of nothing, and the share `model` by
    which a change may differ from what the model gives it."""

    d: Any
    usual: Any
    responses: tuple[Response, ...]
    prior: tuple[float, ...]
    calm: float
    model: float

    def noise(self, causes: Sequence[Weighed] = ()) -> Any:
        """Return the covariance (n, n) of changes whose causes are known in size."""
        size = sum((np.where(np.isfinite(c.moved), c.moved, 0.0) ** 2 for c in causes), self.d**2)
        return self.usual + np.diag(self.model**2 * size)

    def spread(self, one: Explanation, but: int = -1) -> Any:
        """Return the covariance (n, n) of changes with the causes of an explanation set aside, but for one of them."""
        whole = self.noise(one.found)
        for n, cause in enumerate(one.found):
            if n != but:
                whole = whole + (cause.slope * cause.prior**2) @ cause.slope.T
        return whole

    def left(self, one: Explanation, but: int = -1) -> Any:
        """Return what is left (n,) of the changes with the causes of an explanation set aside, but for one of them."""
        gone = sum((c.moved - c.slope @ c.size for n, c in enumerate(one.found) if n != but), np.zeros(len(self.d)))
        return self.d - gone - (0.0 if one.beside is None else one.beside)


@dataclass(frozen=True, eq=False)
class Explanation:
    """Causes by their `numbers` among the responses, each `found` at its size, what they do together `beside` the sum
    (n,), and the logarithm of the `odds`."""

    numbers: tuple[int, ...] = ()
    found: tuple[Weighed, ...] = ()
    beside: Any = None
    odds: float = 0.0

    def without(self, number: int) -> Explanation:
        """Return the same without one of its causes."""
        kept = [n for n in range(len(self.numbers)) if n != number]
        return Explanation(tuple(self.numbers[n] for n in kept), tuple(self.found[n] for n in kept), self.beside)


def explained(what: Changed, model: Modelled) -> Explanation:
    """Return the likeliest explanation: without causes where nothing unusual is the likeliest."""
    best = _judged(what, Explanation())
    for _ in range(MOST):
        wider = _widest(what, best)
        if wider is best:
            return best
        settled = _settled(what, model, wider)
        if settled.odds <= best.odds:
            return best
        best = settled
    return best


def _widest(what: Changed, best: Explanation) -> Explanation:
    """Return the likeliest explanation that has the causes of another one and more, each taken to do what it does
    alone; that other one where none is likelier."""
    beam = [best]
    while beam and len(beam[0].numbers) < MOST:
        beam = _wider(what, beam)
        if not beam or beam[0].odds <= best.odds:
            break
        best = beam[0]
    return best


def _wider(what: Changed, beam: Sequence[Explanation]) -> list[Explanation]:
    """Return the likeliest explanations with one cause more than those of a beam."""
    wider: dict[tuple[int, ...], tuple[float, Explanation]] = {}
    for one in beam:
        found = weighed_beside(what, one)
        for n in sorted(range(len(found)), key=lambda n: -found[n].evidence - what.prior[n])[: 2 * BESIDE]:
            key = tuple(sorted((*one.numbers, n)))
            if n in one.numbers or not np.isfinite(found[n].evidence):
                continue
            odds = found[n].evidence + sum(what.prior[m] for m in key)
            if key not in wider or odds > wider[key][0]:
                wider[key] = odds, Explanation((*one.numbers, n), (*one.found, found[n]), one.beside)
    likely = sorted(wider.values(), key=lambda pair: -pair[0])[: 2 * BESIDE]
    return sorted((together(what, None, one) for _, one in likely), key=lambda one: -one.odds)[:BESIDE]


def weighed_beside(what: Changed, beside: Explanation, but: int = -1) -> list[Weighed]:
    """Return every cause weighed with those of an explanation set aside, but for one of them."""
    spread, left = what.spread(beside, but), what.left(beside, but)
    return [weighed(r, spread, left) for r in what.responses]


def together(
    what: Changed, model: Modelled | None, one: Explanation, rounds: int = ROUNDS, *, anew: bool = False
) -> Explanation:
    """Return an explanation with its causes at the sizes that explain most together. `model`: by which what they do
    together is traced; without it that is the sum of what each does. `anew`: their slopes are traced, too."""
    responses, sizes = [what.responses[n] for n in one.numbers], [f.size for f in one.found]
    best, least = Explanation(), math.inf
    for number in range(rounds):
        moved = [_known(r.at(s)) for r, s in zip(responses, sizes, strict=True)]
        slopes = [
            _slope(model, responses, sizes, m) if model and anew else _known(r.slope_at(s))
            for m, (r, s) in enumerate(zip(responses, sizes, strict=True))
        ]
        found = tuple(
            replace(f, size=z, moved=m, slope=s) for f, z, m, s in zip(one.found, sizes, moved, slopes, strict=True)
        )
        beside = one.beside if model is None else _whole(model, responses, sizes, moved) - sum(moved, 0.0)
        now = _judged(what, Explanation(one.numbers, found, beside))
        if (off := _misfit(what, now)) < least:
            best, least = now, off
        if number == rounds - 1:
            break
        last, sizes = sizes, _sizes(what, now)
        near = [0.1 * np.sqrt(np.maximum(0.0, np.diagonal(f.spread))) for f in now.found]
        if all((np.abs(a - b) <= n + 1e-12).all() for a, b, n in zip(sizes, last, near, strict=True)):
            break
    return best


def _misfit(what: Changed, one: Explanation) -> float:
    """Return how far an explanation is from what changed, in variances, with how rare the sizes of its causes are."""
    left = what.d - sum((f.moved for f in one.found), np.zeros(len(what.d)))
    left = left - (0.0 if one.beside is None else one.beside)
    rare = sum(float(np.sum((f.size / f.prior) ** 2)) for f in one.found if len(f.size))
    return float(left @ np.linalg.solve(what.noise(one.found), left)) + rare


def _known(changes: Any) -> Any:
    """Return changes, 0 where they are not known."""
    return np.where(np.isfinite(changes), changes, 0.0)


def _whole(model: Modelled, responses: Sequence[Response], sizes: Sequence[Any], moved: Sequence[Any]) -> Any:
    """Return what causes do together (n,): by the model, or, where it does not tell, as the sum of what each does."""
    steps = [s for r, size in zip(responses, sizes, strict=True) for s in r.steps(size)]
    whole = model.changes(steps) if steps else np.zeros(len(model.lowest))
    whole = np.where(np.isfinite(whole), whole, sum(moved, np.zeros(len(whole))))
    for response, one in zip(responses, moved, strict=True):
        if not response.cause.ways:  # light that is kept back, which is no change of the model
            whole = np.minimum(whole, np.where(one < 0, one, whole))
    return whole


def _sizes(what: Changed, one: Explanation) -> list[Any]:
    """Return the sizes of the causes of an explanation that explain most together, by their slopes."""
    if not one.found:
        return []
    slope = np.concatenate([f.slope for f in one.found], axis=1)
    prior = np.diag(np.concatenate([f.prior for f in one.found]) ** 2)
    spread = what.noise(one.found)
    size = prior @ slope.T @ np.linalg.solve(spread + slope @ prior @ slope.T, what.left(one))
    ends = np.cumsum([0, *(f.slope.shape[1] for f in one.found)])
    return [size[a:b] for a, b in pairwise(ends)]


def _slope(model: Modelled, responses: Sequence[Response], sizes: Sequence[Any], number: int) -> Any:
    """Return the derivatives (n, k) of the quantities by one of some causes, all at their sizes."""
    own, size = responses[number], sizes[number]
    near = own.slope_at(size)
    if all(abs(s) < 2 * w.step for s, w in zip(size, own.cause.ways, strict=True)) and len(responses) == 1:
        return _known(near)
    others = [s for m, r in enumerate(responses) if m != number for s in r.steps(sizes[m])]
    columns = []
    for k, way in enumerate(own.cause.ways):
        by = way.step / 4 * np.eye(len(size))[k]
        ends = [model.changes([*others, *own.steps(there)]) for there in (size - by, size + by)]
        slope = (ends[1] - ends[0]) / (way.step / 2)
        columns.append(np.where(np.isfinite(slope), slope, np.where(np.isfinite(near[:, k]), near[:, k], 0.0)))
    return np.stack(columns, axis=1) if columns else near


def _judged(what: Changed, one: Explanation) -> Explanation:
    """Return an explanation with its odds."""
    odds = normal(what.spread(one), what.left(one)) + (0.0 if one.numbers else what.calm)
    if not one.numbers:
        return replace(one, odds=odds)
    covariance = _covariance(what, one)
    sizes = np.concatenate([f.size for f in one.found])
    ways = [way for n in one.numbers for way in what.responses[n].cause.ways]
    for n, way in enumerate(ways):
        if way.one_sided:
            odds += one_sided(float(sizes[n]), float(covariance[n, n]))
    odds += sum(share_of(f, what.responses[n].cause) for n, f in zip(one.numbers, one.found, strict=True))
    ends = np.cumsum([0, *(len(f.size) for f in one.found)])
    found = tuple(replace(f, spread=covariance[a:b, a:b]) for f, (a, b) in zip(one.found, pairwise(ends), strict=True))
    return replace(one, found=found, odds=odds + sum(what.prior[n] for n in one.numbers))


def _covariance(what: Changed, one: Explanation) -> Any:
    """Return the covariance (k, k) of the sizes of all causes of an explanation."""
    slope = np.concatenate([f.slope for f in one.found], axis=1)
    prior = np.diag(np.concatenate([f.prior for f in one.found]) ** 2)
    whole = what.noise(one.found) + slope @ prior @ slope.T
    return prior - prior @ slope.T @ np.linalg.solve(whole, slope @ prior)


def _settled(what: Changed, model: Modelled, best: Explanation) -> Explanation:
    """Return an explanation modelled as a whole, after each of its causes was dropped or replaced where that explains
    more."""
    best = together(what, model, best)
    for _ in range(MOST):
        other = next(_others(what, model, best), None)
        if other is None:
            break
        best = other
    exact = together(what, model, best, ANEW, anew=True)
    return exact if exact.odds > best.odds - BETTER else best


def _others(what: Changed, model: Modelled, best: Explanation) -> Iterator[Explanation]:
    """Yield explanations that are likelier, with a cause less or another one."""
    for k in range(len(best.numbers)):
        rest = best.without(k)
        less = together(what, None, rest) if rest.numbers else _judged(what, Explanation())
        if less.odds > best.odds - BETTER and rest.numbers:
            less = together(what, model, rest)
        if less.odds > best.odds:
            yield less
        found = weighed_beside(what, less)
        odds = [f.evidence + p for f, p in zip(found, what.prior, strict=True)]
        n = max(range(len(odds)), key=lambda n: odds[n])
        if n not in best.numbers and odds[n] > odds[best.numbers[k]] + BETTER:
            other = together(what, model, Explanation((*less.numbers, n), (*less.found, found[n]), less.beside))
            if other.odds > best.odds + BETTER:
                yield other
