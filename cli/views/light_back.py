"""The light that a commit recorded, against the light now."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from pico.model.measurement import Compared, Restood
from pico.model.record import as_json

from .style import columns, count, listed, paint, wrap

if TYPE_CHECKING:
    from pico.diagnosis.grouping import Suspect

LIKELY = 0.05
"""The probability from which a suspect is told."""
MOST = 8
"""How many suspects are told at most."""
TELLS = 0.1
"""From which share of its standard deviation on it is shown that a number is to be another one."""

_LEAST = 5e-4
"""What is shown of how far a part stands from where it stood, at least [mm, deg]."""


def text(found: Sequence[Compared], *, goal: str = "", suspects: Sequence[Suspect] = ()) -> str:
    """Return each number as the commit recorded it and as it is now, those that differ marked; `goal`: the commit as a
    person calls it; `suspects`: what may be the cause, the likeliest first."""
    follows = any(_expected(one) for one in found)
    head = ["", "light", goal or "recorded", *(["expected"] if follows else []), "now", ""]
    rows = [[paint("dim", cell) for cell in head], *(_row(one, follows) for one in found)]
    off, sure = sum(one.differs for one in found), sum(not one.why for one in found)
    recorded = f"{goal or 'the commit'} recorded{', as parts stand now' if follows else ''}"
    as_it_was = f"{sure} of {count(len(found), 'number')} of the light compared: as {recorded}."
    said = f"{count(off, 'number')} of the light {'differs' if off == 1 else 'differ'} from what {recorded}."
    lines = [*columns(rows, indent="  "), *restood(found), said if off else as_it_was]
    return "\n".join([*lines, *suspected(suspects)])


def _row(one: Compared, follows: bool) -> list[str]:
    """Return a number as a row of the table; `follows`: it shows what numbers are expected to be."""
    if one.why:
        return [paint("yellow", "?"), one.address, "", *([""] if follows else []), "", f"not compared: {one.why}"]
    mark = paint("red", "✗") if one.differs else paint("green", "✓")
    share = f"  {100 * one.share:.1f} % against {one.reference}" if one.reference and one.share is not None else ""
    near = f"± {one.sigma:.3g} {one.unit}".rstrip()
    to_be = [_expected(one)] if follows else []
    return [mark, one.address, f"{one.before:.5g}", *to_be, f"{one.now:.5g}", f"{near}{share}"]


def _expected(one: Compared) -> str:
    """Return what a number is to be where that is another one than before by more than nothing."""
    if one.why or one.expected is None or abs(one.expected - (one.before or 0.0)) < TELLS * one.sigma:
        return ""
    return f"{one.expected:.5g}"


def restood(found: Sequence[Compared]) -> Iterator[str]:
    """Yield the parts that stand otherwise than they stood, and by that make more of a number than its standard
    deviation: `From where it stood, lx_125 stands 0.27 ± 0.03 mm to its right: ...`."""
    makes: dict[str, tuple[Restood, list[str]]] = {}
    for one in found:
        for part in (one.restood or ()) if not one.why else ():
            if abs(part.by) > one.sigma:
                told = f"{part.by:+.4g} {one.unit} of {one.address}"
                makes.setdefault(part.component, (part, []))[1].append(told)
    for component, (part, made) in makes.items():
        yield from wrap(f"From where it stood, {component} stands {_off(part)}: that makes {listed(made)}.", "  ")


def _off(part: Restood) -> str:
    """Return how far a part stands from where it stood: what is more than chance of it, or the most."""
    ways = [
        (part.left, part.position, "mm", "to its left" if part.left > 0 else "to its right"),
        (part.ahead, part.position, "mm", "ahead" if part.ahead > 0 else "back"),
        (part.turned, part.yaw, "deg", "counterclockwise" if part.turned > 0 else "clockwise"),
    ]
    sure = [way for way in ways if abs(way[0]) > max(2 * way[1], _LEAST)]
    said = []
    for size, sigma, unit, way in sure or [max(ways, key=lambda w: abs(w[0]) / (w[1] or 1.0))]:
        near = f" ± {sigma:.1g}" if sigma else ""
        digits = max(2, -math.floor(math.log10(sigma))) if sigma else 3
        said.append(f"{abs(size):.{digits}f}{near} {unit} {way}")
    return listed(said)


def suspected(suspects: Sequence[Suspect]) -> list[str]:
    """Return what probably happened, the likeliest first: `87 %  ly_150: moved across, +0.05 ± 0.002 mm up`."""
    from .suspects import lines

    if not suspects:
        return []
    return lines([one for one in suspects if one.part][:MOST], LIKELY) or [
        "  No single change of a known part explains it."
    ]


def data(found: Sequence[Compared], *, goal: str = "", suspects: Sequence[Suspect] = ()) -> dict[str, Any]:
    """Return schema `pico.light-compared/v1`: `numbers` with `before`, `now`, `sigma`, and whether each `differs`;
    `suspects` by probability, as a morning has them."""
    told = [as_json(one) for one in suspects]
    return {"schema": "pico.light-compared/v1", "goal": goal, "numbers": numbers(found), "suspects": told}


def numbers(found: Sequence[Compared]) -> list[dict[str, Any]]:
    """Return the numbers as JSON data, with whether each differs."""
    return [{**as_json(one), "differs": one.differs} for one in found]
