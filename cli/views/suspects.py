"""Suspects of one cause, with a probability only where readings support it.

How probable one of them is that readings cannot distinguish from another is the prior alone: these get one probability
together, and a line each without one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .style import listed, paint, wrap

if TYPE_CHECKING:
    from pico.diagnosis.grouping import Suspect

MOST, MANY = 4, 8
"""How many kinds of cause are told of those that readings cannot distinguish, and how many names in a row."""
_INDENT = " " * 9


def lines(suspects: Sequence[Suspect], least: float) -> list[str]:
    """Return what may have happened, the likeliest first, where it is at least so probable that it is told."""
    rows, left = list[str](), [one for one in suspects if one.part]
    while left:
        first = left[0]
        same = [one for one in left if one is first or not _told_apart(first, one)]
        left = [one for one in left if one not in same]
        if (share := sum(one.probability for one in same)) >= least:
            rows += _together(share, same, least)
    return rows


def _told_apart(one: Suspect, other: Suspect) -> bool:
    """Return whether readings distinguish two suspects."""
    if one.part == other.part:
        return not set(one.like) & set(other.like)
    return other.part not in one.like and one.part not in other.like


def _together(share: float, same: Sequence[Suspect], least: float) -> list[str]:
    """Return suspects that readings cannot distinguish, with their probability together; of several only those that
    are `least` so probable by themselves, and the likeliest."""
    kinds: dict[str, list[Suspect]] = {}
    for one in same:
        kinds.setdefault(one.kind, []).append(one)
    shown = [of for of in kinds.values() if sum(s.probability for s in of) >= least or of[0] is same[0]][:MOST]
    told = {one.part for of in shown for one in of}
    texts = [_said(of) for of in shown]
    if len(texts) > 1:
        texts = ["one of these, which the readings do not tell apart:", *(f"- {said}" for said in texts)]
    first, *rest = texts
    head, *more = wrap(first, _INDENT)
    rows = [f"  {100 * share:3.0f} %  {head.strip()}", *more, *(row for said in rest for row in wrap(said, _INDENT))]
    if others := [part for part in same[0].like if part not in told]:
        said = f"No reading tells {same[0].part} from {listed(others)}, where another change would show the same."
        rows += [paint("dim", row) for row in wrap(said, _INDENT)]
    return rows


def _said(of: Sequence[Suspect]) -> str:
    from .morning import said

    parts = [one.part for one in of]
    who = parts[0] if len(parts) == 1 else f"one of {listed(parts, MANY)}, which nothing tells apart"
    return f"{who}: {said(of[0])}"
