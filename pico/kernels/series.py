"""Widths of a beam on a series of pictures, along axes that stay the same from picture to picture: what a caustic is
fitted to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.diagnostics import PicoError, error
from pico.kernels.frame import Readings
from pico.kernels.kernel import Result
from pico.kernels.pipeline import Pipeline, parsed, run

_ROUND = 0.87
"""The ratio of the axes from which ISO 11146-1 calls a beam round."""


@dataclass(frozen=True)
class Along:
    """A `result` of the widths along an axis: `axis` in words, empty for a round beam."""

    axis: str
    result: Result


def split(text: str) -> tuple[Pipeline, Pipeline | None]:
    """Return the kernels of a picture, and those of the readings that a series of pictures gives, if the last is of
    that kind: `d4sigma | m2(wavelength=632.8)`. Raises PicoError for kernels that are none."""
    words = [word.strip() for word in text.split("|")]
    words = words[1:] if words[0] == "image" else words
    last = words[-1].partition("(")[0].strip()
    if last != "m2":
        return parsed(" | ".join(["image", *words])), None
    widths = parsed(" | ".join(["image", *(words[:-1] or ["d4sigma"])]))
    if not {"major", "minor", "angle"} <= widths.last.units.keys():
        text = f"`m2` is of widths, and `{widths.steps[-1].name}` gives none"
        raise PicoError(error("kernel", text, hint="`d4sigma | m2(wavelength=632.8)`, or after `gaussian_fit`"))
    return widths, parsed(f"readings | {words[-1]}")


def along(widths: Sequence[Result], places: Sequence[float], last: Pipeline) -> tuple[Along, ...]:
    """Return what kernels of readings make of the widths at places [mm]: of both principal axes, or of the one width of
    a beam that is round in all pictures. Pictures without widths are left out."""
    known = [(r, z) for r, z in zip(widths, places, strict=True) if not r.unknown]
    if not known:
        return (Along("", Result(unknown="no picture gives a width")),)
    if all(r.value["minor"] > _ROUND * r.value["major"] for r, _ in known):
        found = [(math.sqrt((r.value["major"] ** 2 + r.value["minor"] ** 2) / 2), _mean_sigma(r), z) for r, z in known]
        return (Along("", _run(last, found)),)
    axis = _axis([r for r, _ in known])
    out = []
    for angle in (axis, axis + 90):
        found = [(*_width(r, angle), z) for r, z in known]
        out.append(Along(f"at {(angle + 90) % 180 - 90:.0f} deg", _run(last, found)))
    return tuple(out)


def _run(last: Pipeline, found: Sequence[tuple[float, float, float]]) -> Result:
    values, sigma, places = zip(*found, strict=True)
    return run(last, Readings(values, sigma, places=places))


def _mean_sigma(r: Result) -> float:
    return math.hypot(*(r.value[n] * r.sigma[n] for n in ("major", "minor"))) / math.hypot(
        r.value["major"], r.value["minor"]
    )


def _axis(found: Sequence[Result]) -> float:
    """The direction of a principal axis [deg]: long before a focus and short behind it is the same axis, so a quarter
    turn counts as none."""
    weights = [(r.value["major"] ** 2 - r.value["minor"] ** 2, math.radians(4 * r.value["angle"])) for r in found]
    up, right = (sum(w * f(a) for w, a in weights) for f in (math.sin, math.cos))
    return math.degrees(math.atan2(up, right)) / 4


def _width(r: Result, angle: float) -> tuple[float, float]:
    """The width along a direction [deg] and its standard deviation."""
    turned = math.radians(r.value["angle"] - angle)
    shares = (math.cos(turned) ** 2, math.sin(turned) ** 2)
    pairs = [(r.value[n], r.sigma[n], share) for n, share in zip(("major", "minor"), shares, strict=True)]
    width = math.sqrt(sum(share * value**2 for value, _, share in pairs))
    return width, math.hypot(*(share * value * sigma for value, sigma, share in pairs)) / width
