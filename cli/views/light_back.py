"""The light that a commit recorded, against the light now."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.measurement import Compared
from pico.model.record import as_json

from .style import columns, count, listed, paint, wrap

if TYPE_CHECKING:
    from pico.diagnosis.suspects import Suspect

LIKELY = 0.05
"""The probability from which a suspect is told."""


def text(found: Sequence[Compared], *, goal: str = "", suspects: Sequence[Suspect] = ()) -> str:
    """Return each number as the commit recorded it and as it is now, those that differ marked; `goal`: the commit as a
    person calls it; `suspects`: what may be the cause, the likeliest first."""
    rows = [[paint("dim", cell) for cell in ("", "light", goal or "recorded", "now", "")]]
    for one in found:
        if one.why:
            rows.append([paint("yellow", "?"), one.address, "", "", f"not compared: {one.why}"])
            continue
        mark = paint("red", "✗") if one.differs else paint("green", "✓")
        share = f"{100 * one.share:.1f} %" if one.reference and one.share is not None else ""
        against = f"{share} against {one.reference}" if share else ""
        near = f"± {one.sigma:.3g} {one.unit}".rstrip()
        rows.append([mark, one.address, f"{one.before:.5g}", f"{one.now:.5g}", f"{near}  {against}".rstrip()])
    off = sum(one.differs for one in found)
    verb = "differs" if off == 1 else "differ"
    compared = sum(not one.why for one in found)
    as_it_was = (
        f"{compared} of {count(len(found), 'number')} of the light compared: as {goal or 'the commit'} recorded."
    )
    said = f"{count(off, 'number')} of the light {verb} from what {goal or 'the commit'} recorded."
    lines = [*columns(rows, indent="  "), said if off else as_it_was]
    return "\n".join([*lines, *suspected(suspects)])


def suspected(suspects: Sequence[Suspect]) -> list[str]:
    """Return what probably happened, the likeliest first: `87 %  ly_150: moved across, +0.05 ± 0.002 mm up`."""
    from .morning import said

    known = [one for one in suspects if one.part and one.probability >= LIKELY][:3]
    if not suspects:
        return []
    lines = [f"  {100 * one.probability:3.0f} %  {one.part}: {said(one)}" for one in known]
    if known and known[0].like:
        rest = f"No reading tells {known[0].part} from {listed(known[0].like)}, where the same would show the same."
        lines += [paint("dim", row) for row in wrap(rest, "         ")]
    return lines or ["  No single change of a known part explains it."]


def data(found: Sequence[Compared], *, goal: str = "", suspects: Sequence[Suspect] = ()) -> dict[str, Any]:
    """Return schema `pico.light-compared/v1`: `numbers` with `before`, `now`, `sigma`, and whether each `differs`;
    `suspects` by probability, as a morning has them."""
    told = [as_json(one) for one in suspects]
    return {"schema": "pico.light-compared/v1", "goal": goal, "numbers": numbers(found), "suspects": told}


def numbers(found: Sequence[Compared]) -> list[dict[str, Any]]:
    """Return the numbers as JSON data, with whether each differs."""
    return [{**as_json(one), "differs": one.differs} for one in found]
