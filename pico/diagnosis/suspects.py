"""What most likely happened to a bench between two readings of it: causes weighed by Bayes' theorem.

Quantities y (n,) were read then and now, with standard deviations; d = now - then. A ray model of the bench as it is
known gives the derivatives J (n, k) of the quantities by the k ways of a cause. With nothing unusual,

    d ~ N(0, C),  C = diag(sigma_then^2 + sigma_now^2 + (MODEL d)^2) + sum over all ways of usual^2 j j'

as every part goes astray a little by itself; a cause whose ways have the standard deviations S = diag(fault) gives

    d ~ N(0, C + J S^2 J'),  with the size  a = S^2 J' (C + J S^2 J')^-1 d,
                             spread  (S^-2 + J' C^-1 J)^-1

where a one-sided way counts only for a > 0: its evidence is multiplied by 2 Phi(a / spread). The likeliest causes, and
all that bend (an axis that slipped near a null), are linearized anew at the size that explains most by the model
itself, d then counted from there. The prior is QUIET for nothing unusual, OTHER for
something that no cause explains (each quantity free by WILD of its standard deviation), and the rest shared evenly
among parts, and of each part among its causes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause
from pico.diagnosis.curves import bends
from pico.diagnosis.modelled import Modelled, Slopes
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.quantities import Got, Quantity
from pico.diagnosis.weighing import Weighed, alike, direction, normal, weighed

MODEL = 0.03
"""By which share a change may be another than the model gives it, one standard deviation."""
QUIET, OTHER, WILD = 0.9, 0.005, 30.0
KEPT = 4
"""How many causes are modelled anew, the likeliest, besides those that bend."""
SURE = 3.0
"""The logarithm of the odds of nothing unusual above which none is."""


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
    model = Modelled(nominal, tuple(c.quantity for c in known))
    slopes = model.slopes(possible)
    lean = [c for c in possible if any(slopes[c.part, w.what].any() for w in c.ways)]
    usual = _usual(known, lean, slopes)
    spread = usual + np.diag((MODEL * d) ** 2)
    found = [weighed(c, np.stack([slopes[c.part, w.what] for w in c.ways], axis=1), spread, d) for c in lean]
    prior, calm = _prior(lean), normal(spread, d) + math.log(QUIET)
    for n in _worth(lean, [f.evidence + p for f, p in zip(found, prior, strict=True)], calm):
        found[n] = model.nearer(lean[n], found[n], spread, d)
    odds = np.array([
        *(f.evidence + p for f, p in zip(found, prior, strict=True)),
        calm, normal(spread * WILD**2, d) + math.log(OTHER),
    ])  # fmt: skip
    shares = np.exp(odds - odds.max()) / np.exp(odds - odds.max()).sum()
    directions = [direction(f.slope, c, spread) for f, c in zip(found, lean, strict=True)]
    told = [_suspect(c, f, float(share), alike(n, lean, directions))
            for n, (c, f, share) in enumerate(zip(lean, found, shares, strict=False))]  # fmt: skip
    told += [
        Suspect("", kind, float(p), {}, {}, {}) for kind, p in zip((NOTHING, UNEXPLAINED), shares[-2:], strict=True)
    ]
    by = {id(c): float(change) for c, change in zip(known, d / np.sqrt(np.diagonal(usual)), strict=True)}
    changes = tuple(by.get(id(c), math.nan) for c in compared)
    return Verdict(tuple(sorted(told, key=lambda s: -s.probability)), changes)


def _usual(known: Sequence[Compared], possible: Sequence[Cause], slopes: Slopes) -> Any:
    """Return the covariance (n, n) of what changes from day to day: noise, and every part a little."""
    spread = np.diag([c.then.sigma**2 + c.now.sigma**2 + 1e-18 for c in known])
    for cause in possible:
        for way in cause.ways:
            j = slopes[cause.part, way.what]
            spread = spread + way.usual**2 * np.outer(j, j)
    return spread


def _worth(possible: Sequence[Cause], odds: Sequence[float], calm: float) -> list[int]:
    """Return the causes that are modelled anew, by their numbers: the likeliest, and all of which slopes tell little;
    none where nothing unusual is by far the likeliest."""
    if not odds or calm - max(odds) > SURE:
        return []
    best = sorted(range(len(odds)), key=lambda n: -odds[n])[:KEPT]
    return list(dict.fromkeys([*best, *(n for n, c in enumerate(possible) if any(bends(w) for w in c.ways))]))


def _prior(possible: Sequence[Cause]) -> list[float]:
    """Return the logarithm of the prior of each cause: parts share evenly, and of each part its causes."""
    counts: dict[str, int] = {}
    for cause in possible:
        counts[cause.part] = counts.get(cause.part, 0) + 1
    rest = 1.0 - QUIET - OTHER
    return [math.log(rest / len(counts) / counts[c.part]) for c in possible]


def _suspect(cause: Cause, found: Weighed, probability: float, like: tuple[str, ...]) -> Suspect:
    names = [w.what for w in cause.ways]
    sigma = np.sqrt(np.maximum(0, np.diagonal(found.spread))).tolist()
    return Suspect(
        cause.part, cause.kind, probability, dict(zip(names, map(float, found.size), strict=True)),
        dict(zip(names, sigma, strict=True)), {w.what: w.unit for w in cause.ways}, like,
    )  # fmt: skip
