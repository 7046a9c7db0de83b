"""What most likely happened to a bench between two readings of it: causes weighed by Bayes' theorem.

Quantities y (n,) were read then and now, with standard deviations; d = now - then. A ray model of the bench as it is
known gives the derivatives J (n, k) of the quantities by the k ways of a cause. With nothing unusual,

    d ~ N(0, C),  C = diag(sigma_then^2 + sigma_now^2 + (MODEL d)^2) + sum over all ways of usual^2 j j'

as every part goes astray a little by itself; a cause whose ways have the standard deviations S = diag(fault) gives

    d ~ N(0, C + J S^2 J'),  with the size  a = S^2 J' (C + J S^2 J')^-1 d,
                             spread  (S^-2 + J' C^-1 J)^-1

where a one-sided way counts only for a > 0: its evidence is multiplied by 2 Phi(a / spread). A cause that d shows to be
large is linearized anew where it is, d then counted from there. The prior is QUIET for nothing unusual, OTHER for
something that no cause explains (each quantity free by WILD of its standard deviation), and the rest shared evenly
among parts, and of each part among its causes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Got, Quantity

MODEL = 0.03
"""By which share a change may be another than the model gives it, one standard deviation."""
QUIET, OTHER, WILD = 0.9, 0.005, 30.0
ROUNDS = 2
"""How often a large cause is linearized anew."""
KEPT = 4
"""Of how many causes that is done, the likeliest."""
ALIKE = 0.98
"""The cosine between what two causes do, by their noise, from which no reading tells them apart."""


@dataclass(frozen=True)
class Compared:
    """A quantity then and now."""

    quantity: Quantity
    then: Got
    now: Got


@dataclass(frozen=True)
class Suspect:
    """A cause, its probability, and its size with one standard deviation, by way; `part` is empty for nothing unusual
    and for what no cause explains. `like`: other parts whose fault would look the same to all readings."""

    part: str
    kind: str
    probability: float
    size: Mapping[str, float]
    sigma: Mapping[str, float]
    units: Mapping[str, str]
    like: tuple[str, ...] = ()


@dataclass(frozen=True)
class Verdict:
    """What most likely happened: suspects, the likeliest first, nothing unusual among them; and each quantity's change
    in standard deviations of what is usual, in the order given."""

    suspects: tuple[Suspect, ...]
    changes: tuple[float, ...]

    @property
    def quiet(self) -> float:
        """The probability that nothing unusual happened."""
        return next(s.probability for s in self.suspects if s.kind == NOTHING)


NOTHING, UNEXPLAINED = "nothing unusual", "something else"


def suspects(nominal: Nominal, compared: Sequence[Compared], possible: Sequence[Cause]) -> Verdict:
    """Return which of the `possible` causes explain what changed, see above."""
    known = [c for c in compared if nominal.quantity(c.quantity) is not None]
    known = [c for c in known if math.isfinite(c.then.value + c.now.value)]
    d = np.array([c.now.value - c.then.value for c in known])
    ways = [(cause, way) for cause in possible for way in cause.ways]
    slopes = nominal.kept("slopes", (repr([c.quantity for c in known]), tuple(possible)),
                          lambda: {(c.part, w.what): _slope(nominal, known, c.part, w) for c, w in ways})  # fmt: skip
    noise = np.array([c.then.sigma**2 + c.now.sigma**2 for c in known])
    spread = np.diag(noise + 1e-18)
    for cause, way in ways:
        j = slopes[cause.part, way.what]
        spread = spread + way.usual**2 * np.outer(j, j)
    usual = np.sqrt(np.diagonal(spread))
    spread = spread + np.diag((MODEL * d) ** 2)
    lean = [c for c in possible if any(slopes[c.part, w.what].any() for w in c.ways)]
    scored = [_weighed(c, np.stack([slopes[c.part, w.what] for w in c.ways], axis=1), spread, d) for c in lean]
    prior = _prior(lean)
    order = sorted(range(len(lean)), key=lambda n: -(scored[n].evidence + prior[n]))
    for n in order[:KEPT]:
        scored[n] = _again(nominal, known, lean[n], scored[n], spread, d)
    odds = [s.evidence + p for s, p in zip(scored, prior, strict=True)]
    odds += [_normal(spread, d) + math.log(QUIET), _normal(spread * WILD**2, d) + math.log(OTHER)]
    top = max(odds)
    weights = np.exp(np.array(odds) - top)
    weights = weights / weights.sum()
    directions = [_direction(s.slope, c, spread) for s, c in zip(scored, lean, strict=True)]
    found = [
        replace(_suspect(c, s, float(w)), like=_alike(n, lean, directions))
        for n, (c, s, w) in enumerate(zip(lean, scored, weights, strict=False))
    ]
    found += [
        Suspect("", NOTHING, float(weights[-2]), {}, {}, {}),
        Suspect("", UNEXPLAINED, float(weights[-1]), {}, {}, {}),
    ]
    by = {id(c): float(change / u) for c, change, u in zip(known, d, usual, strict=True)}
    return Verdict(
        tuple(sorted(found, key=lambda s: -s.probability)), tuple(by.get(id(c), math.nan) for c in compared)
    )  # fmt: skip


@dataclass(frozen=True)
class _Scored:
    evidence: float
    size: Any
    spread: Any
    slope: Any


def _weighed(cause: Cause, slope: Any, spread: Any, d: Any) -> _Scored:
    prior = np.diag([w.fault**2 for w in cause.ways])
    whole = spread + slope @ prior @ slope.T
    size = prior @ slope.T @ np.linalg.solve(whole, d)
    covariance = prior - prior @ slope.T @ np.linalg.solve(whole, slope @ prior)
    evidence = _normal(whole, d)
    for n, way in enumerate(cause.ways):
        if way.one_sided:
            evidence += math.log(max(1e-300, math.erfc(-size[n] / math.sqrt(2 * max(covariance[n, n], 1e-30)))))
    return _Scored(evidence, size, covariance, slope)


def _again(nominal: Nominal, known: Sequence[Compared], cause: Cause, at: _Scored, spread: Any, d: Any) -> _Scored:
    """Return a cause weighed where it is most likely, by the model there."""
    base = _read(nominal, known, ())
    best = at
    for _ in range(ROUNDS):
        if all(abs(s) < 2 * w.step for s, w in zip(best.size, cause.ways, strict=True)):
            break
        steps = _steps(cause, best.size)
        there = _read(nominal, known, steps)
        told = np.isfinite(there)
        moved = np.where(told, there - base, at.slope @ best.size)
        if len(cause.ways) == 1:  # from nothing to there, along the chord
            best = _weighed(cause, (moved / best.size[0])[:, None], spread, d)
        else:
            best = _weighed(cause, at.slope, spread, d - moved + at.slope @ best.size)
    return best


def _steps(cause: Cause, size: Any) -> tuple[Step, ...]:
    return tuple(Step(cause.part, w.what, round(float(s), 9)) for w, s in zip(cause.ways, size, strict=True))


def _read(nominal: Nominal, known: Sequence[Compared], steps: Sequence[Step]) -> Any:
    found = [nominal.quantity(c.quantity, steps) for c in known]
    return np.array([math.nan if one is None else one.value for one in found])


def _slope(
    nominal: Nominal, known: Sequence[Compared], part: str, way: Way
) -> Any:  # fmt: skip
    """Return the derivatives (n,) of the quantities by one way of a part, 0 where the model does not tell."""
    slope = (_read(nominal, known, (Step(part, way.what, way.step),)) - _read(nominal, known, ())) / way.step
    return np.where(np.isfinite(slope) & (np.abs(slope) * way.fault > 1e-9), slope, 0.0)


def _normal(spread: Any, d: Any) -> float:
    """Return the logarithm of a normal density of mean 0, without the constant."""
    _, size = np.linalg.slogdet(spread)
    return float(-0.5 * d @ np.linalg.solve(spread, d) - 0.5 * size)


def _prior(possible: Sequence[Cause]) -> list[float]:
    """Return the logarithm of the prior of each cause: parts share evenly, and of each part its causes."""
    counts: dict[str, int] = {}
    for cause in possible:
        counts[cause.part] = counts.get(cause.part, 0) + 1
    rest = 1.0 - QUIET - OTHER
    return [math.log(rest / len(counts) / counts[c.part]) for c in possible]


def _direction(slope: Any, cause: Cause, spread: Any) -> Any:
    """Return what a cause does to the quantities, each way by its size, in units of the noise."""
    root = np.linalg.cholesky(np.linalg.inv(spread)).T
    return root @ (slope * np.array([w.fault for w in cause.ways]))


def _alike(number: int, possible: Sequence[Cause], directions: Sequence[Any]) -> tuple[str, ...]:
    """Return the parts of which some cause spans what this one does."""
    own = directions[number]
    found = set()
    for n, other in enumerate(directions):
        if possible[n].part == possible[number].part:
            continue
        base, _ = np.linalg.qr(other)
        kept, size = np.linalg.norm(base @ (base.T @ own)), np.linalg.norm(own)
        if size > 0 and kept / size > ALIKE:
            found.add(possible[n].part)
    return tuple(sorted(found))


def _suspect(cause: Cause, scored: _Scored, probability: float) -> Suspect:
    names = [w.what for w in cause.ways]
    return Suspect(
        cause.part, cause.kind, probability, dict(zip(names, map(float, scored.size), strict=True)),
        dict(zip(names, map(math.sqrt, np.maximum(0, np.diagonal(scored.spread)).tolist()), strict=True)),
        {w.what: w.unit for w in cause.ways},
    )  # fmt: skip
