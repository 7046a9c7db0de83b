"""Between which wavelengths the numbers of a part hold, and what is said of light outside."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.catalog import ComponentType
from pico.model.materials.glass import GLASSES
from pico.model.materials.response import blind
from pico.model.pose import short
from pico.model.setup import Setup

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


def unfit(kind: ComponentType, name: str, source: str, wavelength: float) -> Iterator[Diagnostic]:
    """Yield a warning if a part is not made for the light of a source [nm] that comes to it."""
    if why := sees_nothing(kind, wavelength):
        text, hint = f"{name} is blind to the beam of {source}: {why}", "take a detector of another material"
        yield warning("outside-range", text, hint=hint, address=name)
    elif why := outside(kind, wavelength):
        hint = f"take a part for {short(wavelength)} nm, or give its own range: `parameters: {{longest: ...}}`"
        yield warning("outside-range", f"{name} is {why} ({source})", hint=hint, address=name)


def band(kind: ComponentType, cosine: float) -> tuple[float, float] | None:
    """Return between which wavelengths [nm] a bandpass filter passes light that comes to it at a cosine of incidence;
    None for what is no bandpass. Its center is at shorter wavelengths if it is tilted, as its layers have it: times
    (1 - sin^2 / n^2)^1/2 with the `effective_index` n."""
    center, width = kind.number("center_wavelength", "nm"), kind.number("bandwidth", "nm")
    if kind.optics.element != "bandpass" or center is None or width is None:
        return None
    index = kind.number("effective_index", "")
    middle = center * math.sqrt(max(0.0, 1 - (1 - cosine**2) / (2.0 if index is None else index) ** 2))
    return middle - width / 2, middle + width / 2


def unfit_band(kind: ComponentType, name: str, light: Mapping[str, tuple[float, float]]) -> Iterator[Diagnostic]:
    """Yield a warning if a bandpass filter passes nothing of all the `light` that comes to it: by source, the
    wavelength [nm] and the cosine of incidence."""
    bands = {source: (band(kind, cosine), wavelength) for source, (wavelength, cosine) in light.items()}
    for source, (own, wavelength) in sorted(bands.items()):
        if own is None or any(b is None or b[0] <= w <= b[1] for b, w in bands.values()):
            return
        text = f"{name} blocks the beam of {source}: it passes {own[0]:.4g} to {own[1]:.4g} nm"
        hint = f"take a filter for {short(wavelength)} nm, or move {name} out of the beam"
        yield warning("outside-range", f"{text}, and the light has {short(wavelength)} nm", hint=hint, address=name)
