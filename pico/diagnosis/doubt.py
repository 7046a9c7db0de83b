"""Causes that may be wrong, as far as the program knows: those of an explanation that leaves readings unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pico.diagnosis.explanations import Changed, Explanation
from pico.diagnosis.grouping import Suspect

POSSIBLE = "may have changed"
"""The kind of a suspect that is one of several parts of which one or more account for what is not explained."""
UNEXPLAINED = 5.0
"""Standard deviations of what causes leave of a change from which something else must have happened."""
SHOWN, EXPLAINED = 3.0, 3.0
"""Standard deviations from which a part is taken to reach a reading, and up to which a reading is explained."""
NEAR = 4.0
"""By which factor the sum of squares that an explanation leaves may be greater than that of the best, to be near it."""
SEVERAL = 3
"""How many near explanations must agree on a cause."""


def doubted(
    what: Changed, best: Explanation, others: Sequence[Explanation], groups: Sequence[tuple[Suspect, ...]]
) -> tuple[tuple[Suspect, ...], ...]:
    """Return the groups of suspects of an explanation as they are sure: those of causes that are proven as they are,
    and one of all parts that could, alone or with others, account for the readings that differ, if the best
    explanation leaves readings unexplained. `others`: all explanations that were fitted by the whole model."""
    if not best.numbers or not (np.abs(what.unexplained(best)) > UNEXPLAINED).any():
        return tuple(groups)
    sure = [k for k in range(len(best.numbers)) if _proven(what, best, k) or _agreed(what, best, k, others)]
    named = {what.responses[best.numbers[k]].cause.part for k in sure}
    parts = [part for part in _reaching(what, best) if part not in named]
    kept = [groups[k] for k in sure]
    share = 1.0 / max(1, len(parts))
    like = {part: tuple(p for p in parts if p != part) for part in parts}
    rest = tuple(Suspect(part, POSSIBLE, share, {}, {}, {}, like[part]) for part in parts)
    return (*kept, rest) if rest else tuple(kept)


def _reach(what: Changed, part: str) -> Any:
    """Return which readings (n,) a part could change so that it shows."""
    noise = np.sqrt(np.diagonal(what.usual))
    own = [r.moved for r in what.responses if r.cause.part == part]
    return np.any([(np.abs(np.where(np.isnan(m), np.inf, m)) > SHOWN * noise).any(axis=0) for m in own], axis=0)


def _reaching(what: Changed, best: Explanation) -> list[str]:
    """Return the parts that could change one of the readings that differ, whether they are explained or not."""
    differ = (np.abs(what.d) > UNEXPLAINED * np.sqrt(np.diagonal(what.usual))) | (
        np.abs(what.unexplained(best)) > UNEXPLAINED
    )
    parts = dict.fromkeys(r.cause.part for r in what.responses)
    return [part for part in parts if (_reach(what, part) & differ).any()]


def _proven(what: Changed, best: Explanation, number: int) -> bool:
    """Return whether a reading that changed, and is explained, could have been changed by the part of a cause alone, as
    the monitor of a laser or the dark level of a camera."""
    part = what.responses[best.numbers[number]].cause.part
    noise = np.sqrt(np.diagonal(what.usual))
    mine = (np.abs(what.d) > UNEXPLAINED * noise) & (np.abs(what.unexplained(best)) < EXPLAINED)
    mine &= np.abs(best.found[number].moved) > SHOWN * noise
    for other in dict.fromkeys(r.cause.part for r in what.responses):
        if other != part:
            mine &= ~_reach(what, other)
    return bool(mine.any())


def _agreed(what: Changed, best: Explanation, number: int, others: Sequence[Explanation]) -> bool:
    """Return whether several explanations that are near the best have a cause, and none is without it."""
    left = {one.key: float(np.sum(what.unexplained(one) ** 2)) for one in others}
    near = [one for one in others if left[one.key] < NEAR * float(np.sum(what.unexplained(best) ** 2))]
    return len(near) >= SEVERAL and all(best.numbers[number] in one.numbers for one in near)
