"""What most likely happened to a bench between two readings of it: causes weighed by Bayes' theorem.

Quantities y (n,) were read then and now, with standard deviations; d = now - then, less what is expected to have
changed because parts were seen to stand elsewhere. A ray model of the bench as it is known gives what a cause of size
a (k,) does to the quantities, m(a), and its derivatives J (n, k). With nothing unusual,

    d ~ N(0, C),  C = diag(sigma_then^2 + sigma_now^2 + (MODEL d)^2) + sum over all ways of usual^2 j j'

as every part goes astray a little by itself; a cause whose ways have the standard deviations S = diag(fault) gives,
near the size that explains most,

    d - m(a) + J a ~ N(0, C + J S^2 J'),  with the size  a = S^2 J' (C + J S^2 J')^-1 (d - m(a) + J a)

where a one-sided way counts only for a > 0: its evidence is multiplied by 2 Phi(a / spread); of all faults the share
`weighing.RARE` is `weighing.GREAT` times as large. The prior is QUIET for nothing unusual, OTHER for something that no
cause explains (each quantity free by WILD of its standard deviation), and the rest shared evenly among parts, and of
each part among its causes. Several causes are found one after the other (`several`), each by the same prior.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.darkness import losses
from pico.diagnosis.doubt import doubted
from pico.diagnosis.explanations import Changed, Explanation, judged
from pico.diagnosis.grouping import Suspect, grouped, suspect
from pico.diagnosis.modelled import Modelled
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.quantities import FLICKER, Got, Quantity
from pico.diagnosis.responses import Response
from pico.diagnosis.several import Search
from pico.diagnosis.weighing import Weighed, alike, direction, normal, weighed

ROUGH, MODEL = 0.05, 0.005
"""By which share a change may be another than the ray model gives it, one standard deviation: of one cause alone, which
is traced at a few sizes, and of all causes together, traced at theirs."""
QUIET, OTHER, WILD = 0.9, 0.005, 30.0
CHANCE, UNUSUAL = 2.0, 3.0
"""Standard deviations of their sum of squares, and of one of them, up to which changes are taken to be chance."""
OBVIOUS = 30.0
"""Standard deviations of what was read from which a change needs no test of whether it is usual."""
DARK = 0.3
"""The standard deviation of the logarithm of a reading from which there may be no light."""


@dataclass(frozen=True)
class Compared:
    """A quantity then and now; `shift`: by how much it is expected to have changed."""

    quantity: Quantity
    then: Got
    now: Got
    shift: float = 0.0

    @property
    def change(self) -> float:
        """The change beside the expected one."""
        return self.now.value - self.then.value - self.shift

    @property
    def lowest(self) -> float:
        """The least change that can be shown beside the expected one: a share is read no lower than its noise."""
        if self.quantity.law != "share":
            return -math.inf
        noise = math.sqrt(max(0.0, self.now.sigma**2 - FLICKER**2))
        floor = self.now.value + (min(0.0, math.log(2 * noise)) if noise > 0 else _DEEP)
        return min(floor - self.then.value - self.shift, 0.0)


_DEEP = -25.0
"""The logarithm of the least share of a reading whose noise is not known."""


@dataclass(frozen=True)
class Verdict:
    """What most likely happened. `causes`: each thing that did, in the order in which it was found, as the suspects of
    which one did it, the likeliest first; none where nothing unusual is likelier. If they leave readings unexplained,
    only those that are proven are among them, and last a group of parts of which one or several may have changed, see
    `doubt`. `suspects`: all of them, the likeliest first, with nothing unusual and what no cause explains among them.
    `changes`: each quantity's change in standard deviations of what is usual, in the order given. `blind`: the parts
    about which no quantity tells. `left`: what the causes leave of each quantity's change, in its standard deviations.
    """

    suspects: tuple[Suspect, ...]
    changes: tuple[float, ...]
    causes: tuple[tuple[Suspect, ...], ...] = ()
    blind: tuple[str, ...] = ()
    left: tuple[float, ...] = ()

    @property
    def quiet(self) -> float:
        """The probability that nothing unusual happened."""
        return next(s.probability for s in self.suspects if s.kind == NOTHING)


NOTHING, UNEXPLAINED = "nothing unusual", "something else"


def suspects(
    nominal: Nominal, compared: Sequence[Compared], possible: Sequence[Cause], loose: Sequence[tuple[str, Way]] = ()
) -> Verdict:
    """Return which of the `possible` causes explain what changed, see above. `loose`: ways of parts that may have
    changed by their `usual` size besides, as the place of a part that was seen elsewhere is known so well only."""
    known = [c for c in compared if nominal.quantity(c.quantity) is not None]
    known = [c for c in known if math.isfinite(c.then.value + c.now.value + c.shift)]
    model = Modelled(nominal, tuple(c.quantity for c in known), np.array([c.lowest for c in known]))
    if any(c.quantity.law == "share" and c.now.sigma > DARK and c.change < -1 for c in known):
        possible = (*possible, *losses(nominal, tuple(dict.fromkeys(c.part for c in possible))))
    away, once = _loose(model, loose), _once(known)
    obvious = any(abs(c.change) > OBVIOUS * math.hypot(c.then.sigma, c.now.sigma) for c in known)
    whole = _changed(known, model, (model.responses if obvious else model.proportional)(possible), away)
    what = whole.only(once)
    close: tuple[Explanation, ...] = (judged(what, Explanation(exact=True)),)
    pool: tuple[Explanation, ...] = close
    if obvious or _far(what):
        whole = whole if obvious else _changed(known, model, model.responses(possible), away)
        what = whole.only(once)
        search = Search(what, model.only(once))
        close = search.close(search.best())
        pool = tuple(search.pool.values())
    groups = doubted(what, close[0], pool, grouped(what, close))
    told = _told(what, close[0], groups)
    by = dict(zip(map(id, known), (whole.d / np.sqrt(np.diagonal(whole.usual))).tolist(), strict=True))
    left = dict(zip((id(known[n]) for n in once), what.unexplained(close[0]).tolist(), strict=True))
    return Verdict(
        tuple(sorted(told, key=lambda s: -s.probability)), tuple(by.get(id(c), math.nan) for c in compared), groups,
        _blind(what, possible), tuple(left.get(id(c), math.nan) for c in compared),
    )  # fmt: skip


def _once(known: Sequence[Compared]) -> list[int]:
    """Return the numbers of the quantities that are not made of readings that are quantities themselves."""
    single = {c.quantity.shots[0].key for c in known if len(c.quantity.shots) == 1}
    return [
        n for n, c in enumerate(known) if len(c.quantity.shots) == 1 or not {s.key for s in c.quantity.shots} <= single
    ]


def _changed(known: Sequence[Compared], model: Modelled, responses: Sequence[Response], away: Any) -> Changed:
    """Return what is to be explained by causes with some responses. `away`: covariance that is usual besides."""
    shown = (r.shown(model.lowest) for r in responses)
    telling = tuple(r for r in shown if r.slope.any() or (r.moved != 0).any())
    prior = tuple(_prior([r.cause for r in telling]))
    d = np.array([c.change for c in known])
    return Changed(d, _usual(known, telling) + away, telling, prior, math.log(QUIET), MODEL, ROUGH)


def _far(what: Changed) -> bool:
    """Return whether changes are so far from what is usual that causes must be weighed out of proportion, too, and
    several of them."""
    many, calm = len(what.d), judged(what, Explanation())
    if float(what.d @ np.linalg.solve(what.usual, what.d)) > many + CHANCE * math.sqrt(2 * many):
        return True
    likely = max((f.evidence + p for f, p in zip(_alone(what), what.prior, strict=True)), default=-math.inf)
    return likely > calm.odds or bool((what.d**2 > UNUSUAL**2 * np.diagonal(what.usual)).any())


def _alone(what: Changed) -> list[Weighed]:
    """Return each cause weighed as the only one."""
    spread = what.spread(Explanation())
    return [weighed(r, spread, what.d) for r in what.responses]


def _told(what: Changed, best: Explanation, groups: Sequence[Sequence[Suspect]]) -> list[Suspect]:
    """Return all suspects with their probabilities, and what else may be."""
    first = _alone(what)
    calm = normal(what.spread(Explanation()), what.d) + what.calm
    other = (
        normal(what.spread(best) * WILD**2, what.left(best))
        + math.log(OTHER)
        + sum(what.prior[n] for n in best.numbers)
    )
    quiet = [f.evidence + p for f, p in zip(first, what.prior, strict=True)]
    if not groups:
        odds = np.array([*quiet, calm, other])
        shares = np.exp(odds - odds.max()) / np.exp(odds - odds.max()).sum()
        directions = [direction(f, r.cause, what.spread(best)) for f, r in zip(first, what.responses, strict=True)]
        causes = [r.cause for r in what.responses]
        told = [suspect(causes[n], f, float(shares[n]), alike(n, causes, directions)) for n, f in enumerate(first)]
        return [*told, *_rest(float(shares[-2]), float(shares[-1]))]
    top = np.logaddexp(best.odds, other)
    nothing, unexplained = float(np.exp(min(0.0, calm - np.logaddexp(top, calm)))), float(np.exp(other - top))
    if len(groups) == 1:
        left = 1.0 - nothing - unexplained * (1 - nothing)
        return [
            *(replace(s, probability=s.probability * left) for s in groups[0]),
            *_rest(nothing, unexplained * (1 - nothing)),
        ]
    return [*(s for group in groups for s in group), *_rest(nothing, unexplained)]


def _rest(nothing: float, unexplained: float) -> Sequence[Suspect]:
    return [Suspect("", NOTHING, nothing, {}, {}, {}), Suspect("", UNEXPLAINED, unexplained, {}, {}, {})]


def _blind(what: Changed, possible: Sequence[Cause]) -> tuple[str, ...]:
    """Return the parts of whose possible causes none of a usual size would show."""
    noise = np.sqrt(np.diagonal(what.usual))
    shown = {
        r.cause.part for r in what.responses if (np.abs(np.where(np.isfinite(r.moved), r.moved, 0)) > 3 * noise).any()
    }
    return tuple(p for p in dict.fromkeys(c.part for c in possible) if p not in shown)


def _usual(known: Sequence[Compared], responses: Sequence[Response]) -> Any:
    """Return the covariance (n, n) of what changes from day to day: noise, and every part a little."""
    spread = np.diag([c.then.sigma**2 + c.now.sigma**2 + (MODEL * c.shift) ** 2 + 1e-18 for c in known])
    for response in responses:
        for n, way in enumerate(response.cause.ways):
            j = response.slope[:, n]
            spread = spread + way.usual**2 * np.outer(j, j)
    return spread


def _loose(model: Modelled, ways: Sequence[tuple[str, Way]]) -> Any:
    """Return the covariance (n, n) that ways of parts make by their usual size."""
    spread = np.zeros((len(model.wanted), len(model.wanted)))
    for (_, way), j in zip(ways, model.slopes(ways).values(), strict=True):
        spread += way.usual**2 * np.outer(j, j)
    return spread


def _prior(possible: Sequence[Cause]) -> list[float]:
    """Return the logarithm of the prior of each cause: parts share evenly, and of each part its causes."""
    counts: dict[str, int] = {}
    for cause in possible:
        counts[cause.part] = counts.get(cause.part, 0) + 1
    rest = 1.0 - QUIET - OTHER
    return [math.log(rest / len(counts) / counts[c.part]) for c in possible]
