"""Light that comes to a part for which its numbers do not hold, by wavelength."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.catalog import ComponentType
from pico.model.materials.glass import GLASSES
from pico.model.materials.response import blind
from pico.model.pose import Pose, short
from pico.model.setup import Setup
from pico.optics.axis import Axis, Values, beams

_SLACK = 0.5
"""By how much a wavelength may lie outside [nm]: a range is given in whole numbers."""


def word(kind: ComponentType, parameter: str) -> str:
    """Return a parameter of a type that is a word; empty without one."""
    found = kind.parameters.get(parameter)
    return "" if found is None else str(found.value)


def span(kind: ComponentType) -> tuple[float, float]:
    """Return between which wavelengths [nm] the numbers of a type hold: its `shortest` and `longest`, within those of
    its `glass`; without bounds if it says none."""
    low, high = (kind.number(name, "nm") for name in ("shortest", "longest"))
    glass = GLASSES.get(word(kind, "glass"))
    ends = glass.span if glass else (0.0, math.inf)
    return max(low or 0.0, ends[0]), min(high or math.inf, ends[1])


def sees_nothing(kind: ComponentType, wavelength: float) -> str:
    """Return that a detector sees nothing of a wavelength [nm], in words; empty if it sees it."""
    sensor = word(kind, "sensor")
    return f"{sensor} sees nothing at {short(wavelength)} nm" if sensor and blind(sensor, wavelength) else ""


def outside(kind: ComponentType, wavelength: float) -> str:
    """Return that the numbers of a type do not hold at a wavelength [nm], in words: `made for 420 to 680 nm, and the
    light has 1550 nm`; empty if they do."""
    low, high = span(kind)
    if low - _SLACK <= wavelength <= high + _SLACK:
        return ""
    made = f"{short(low)} to {short(high)} nm" if high < math.inf else f"{short(low)} nm and more"
    return f"made for {made}, and the light has {short(wavelength)} nm"


def wavelength_of(setup: Setup, source: str, values: Mapping[str, Any]) -> float | None:
    """Return the wavelength [nm] of a source with these tunables; None if it has no single one."""
    said = values.get("wavelength")
    if isinstance(said, int | float) and not isinstance(said, bool):
        return float(said)
    return setup.type_of(source).number("wavelength", "nm")


def out_of_range(setup: Setup, axis: Axis, values: Values) -> Iterator[Diagnostic]:
    """Yield a warning for each part that a beam comes to and whose numbers do not hold for it."""
    wavelength = wavelength_of(setup, axis.source, values.get(axis.source, {}))
    if wavelength is not None:
        for name in dict.fromkeys(m.component for m in axis.meetings if m.component not in ("", axis.source)):
            yield from unfit(setup.type_of(name), name, axis.source, wavelength)


def unfit(kind: ComponentType, name: str, source: str, wavelength: float) -> Iterator[Diagnostic]:
    """Yield a warning if a part is not made for the light of a source [nm] that comes to it."""
    if why := sees_nothing(kind, wavelength):
        text, hint = f"{name} is blind to the beam of {source}: {why}", "take a detector of another material"
        yield warning("outside-range", text, hint=hint, address=name)
    elif why := outside(kind, wavelength):
        hint = f"take a part for {short(wavelength)} nm, or give its own range: `parameters: {{longest: ...}}`"
        yield warning("outside-range", f"{name} is {why} ({source})", hint=hint, address=name)


def doubts(setup: Setup, poses: Mapping[str, Pose], values: Values, detector: str) -> Sequence[str]:
    """Return which parts on the ways of light to a detector, itself included, are not made for it, in words. Sources
    that are known to be off do not count."""
    found: dict[str, None] = {}
    for axis in beams(setup, poses, values):
        wavelength = wavelength_of(setup, axis.source, values.get(axis.source, {}))
        if wavelength is None or values.get(axis.source, {}).get("emission") is False:
            continue
        for way in axis.ways(detector):
            for meeting in way:
                if meeting.component and (why := outside(setup.type_of(meeting.component), wavelength)):
                    found[f"{meeting.component} is {why}"] = None
    return tuple(found)
