"""Kernels on what was measured: a picture with its settings, and what comes out in the form of a measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError
from pico.kernels.frame import Frame
from pico.kernels.kernel import Result
from pico.kernels.known import kernel
from pico.kernels.pipeline import Pipeline, parsed, run

if TYPE_CHECKING:
    from numpy.typing import NDArray

_KNOWN = ("pixel_size", "exposure", "gain", "full_scale", "black_level", "electrons_per_count", "read_noise")


@dataclass(frozen=True)
class Computed:
    """A number, or several by name, one standard deviation of each, and their units in that order; or why there are
    none. `remark`: what of the picture was left out, in words."""

    value: float | Mapping[str, float] | None
    sigma: float | Mapping[str, float] | None
    unit: str
    unknown: str
    remark: str = ""


def frame_of(array: NDArray[Any], settings: Mapping[str, Any]) -> Frame:
    """Return a picture (h, w) as a frame, with what the settings of its measurement say of the camera; what they do not
    say is as `Frame` has it. Raises ValueError for what is no picture."""
    known = {name: float(settings[name]) for name in _KNOWN if isinstance(settings.get(name), int | float)}
    return replace(Frame(array), **known)  # type: ignore[arg-type]


def computed(pipeline: Pipeline, array: NDArray[Any], settings: Mapping[str, Any]) -> Computed:
    """Return what kernels make of a picture (h, w); raises PicoError where they give no numbers."""
    try:
        found = run(pipeline, frame_of(array, settings))
    except ValueError as exc:
        found = Result(unknown=str(exc))
    unit = pipeline.last.unit
    if found.unknown:
        return Computed(None, None, unit, found.unknown)
    if len(found.value) == 1:
        (name,) = found.value
        return Computed(found.value[name], found.sigma[name], unit, "", found.remark)
    return Computed(found.value, found.sigma, unit, "", found.remark)


def version(pipeline: Pipeline) -> str:
    """Return the versions of the kernels, in their order."""
    return " | ".join(kernel(step.name).KERNEL.version for step in pipeline.steps)


def numbers_by(text: str, name: str) -> tuple[str, ...]:
    """Return what the numbers of the measurable `name` with these kernels are called: its own name where there is one
    number, else `name.x`; none where the text means nothing."""
    return tuple(units_by(text, name))


def units_by(text: str, name: str) -> dict[str, str]:
    """Return the units of the numbers that `numbers_by` names, in their order."""
    try:
        units = parsed(text).last.units
    except PicoError:
        return {}
    return dict.fromkeys((name,), *units.values()) if len(units) == 1 else {f"{name}.{n}": u for n, u in units.items()}


def in_order(text: str | None, numbers: Any) -> Any:
    """Return numbers by name in the order of the kernels that gave them, which is that of their units: a document has
    them by the alphabet. What is no such thing is returned as it is."""
    try:
        units = parsed(text).last.units if text and isinstance(numbers, Mapping) else {}
    except PicoError:
        return numbers
    return {name: numbers[name] for name in units} if units and units.keys() == numbers.keys() else numbers
