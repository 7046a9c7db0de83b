"""Of each cause of an explanation, which parts may be it: those that stand in its place in explanations that are as
good."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause
from pico.diagnosis.explanations import Changed, Explanation
from pico.diagnosis.weighing import Weighed


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


def suspect(cause: Cause, found: Weighed, probability: float, like: tuple[str, ...]) -> Suspect:
    """Return a suspect of a cause that was weighed."""
    names = [w.what for w in cause.ways]
    sigma = np.sqrt(np.maximum(0, np.diagonal(found.spread))).tolist()
    return Suspect(
        cause.part, cause.kind, probability, dict(zip(names, map(float, found.size), strict=True)),
        dict(zip(names, sigma, strict=True)), {w.what: w.unit for w in cause.ways}, like,
    )  # fmt: skip


def grouped(what: Changed, close: Sequence[Explanation]) -> tuple[tuple[Suspect, ...], ...]:
    """Return of each cause of the first of some explanations the suspects of which one did it, the likeliest first:
    with what takes its place in the others."""
    best, *others = close
    places: list[dict[int, list[tuple[float, Weighed]]]] = [{} for _ in best.numbers]
    for one in (best, *others):
        for number, place in _places(what, best, one).items():
            found = one.found[one.numbers.index(number)]
            places[place].setdefault(number, []).append((one.odds, found))
    return tuple(_group(what, place) for place in places)


def _group(what: Changed, place: Mapping[int, Sequence[tuple[float, Weighed]]]) -> tuple[Suspect, ...]:
    """Return the suspects of one cause, by the explanations that have each in its place."""
    odds = {n: float(np.logaddexp.reduce([o for o, _ in found])) for n, found in place.items()}
    whole = float(np.logaddexp.reduce(list(odds.values())))
    causes = [r.cause for r in what.responses]
    order = list(dict.fromkeys(c.part for c in causes))
    told = []
    for n in sorted(odds, key=lambda n: -odds[n]):
        share = float(np.exp(odds[n] - whole))
        near = {causes[m].part for m in odds if causes[m].part != causes[n].part}
        _, found = max(place[n], key=lambda pair: pair[0])
        told.append(suspect(causes[n], found, share, tuple(sorted(near, key=order.index))))
    total = sum(s.probability for s in told)
    return tuple(replaced(s, s.probability / total) for s in told)


def replaced(one: Suspect, probability: float) -> Suspect:
    """Return a suspect with another probability."""
    return Suspect(one.part, one.kind, probability, one.size, one.sigma, one.units, one.like)


def _places(what: Changed, best: Explanation, one: Explanation) -> dict[int, int]:
    """Return by cause of an explanation in place of which cause of the best it stands: those that both have in their
    own, the others where they do most alike; none if there are more of them than places."""
    found = {n: best.numbers.index(n) for n in one.numbers if n in best.numbers}
    free = [k for k, n in enumerate(best.numbers) if n not in one.numbers]
    others = [n for n in one.numbers if n not in found]
    if len(others) > len(free):
        return {}
    noise = np.sqrt(np.diagonal(what.noise(best)))
    mine = [_unit(best.found[k].moved / noise) for k in free]
    theirs = [_unit(one.found[one.numbers.index(n)].moved / noise) for n in others]
    ways = permutations(range(len(free)), len(others))
    same = max(ways, key=lambda way: sum(abs(float(mine[k] @ t)) for k, t in zip(way, theirs, strict=True)))
    return found | {n: free[k] for n, k in zip(others, same, strict=True)}


def _unit(moved: Any) -> Any:
    size = float(np.linalg.norm(moved))
    return moved / size if size else moved
