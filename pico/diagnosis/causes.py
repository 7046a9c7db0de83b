"""What may have happened to a part that no camera over the bench sees: how far it usually goes by itself from one day
to the next, and how far when something happened."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from pico.diagnosis.nominal import ZERO
from pico.model.catalog import ComponentType
from pico.model.setup import Setup

_AXES = ("angle", "opening", "tip", "tilt")
"""Axes whose zero is looked for; where a stage's slipped, its optic has moved."""
_STEERS = ("mirror", "plate_splitter", "beam_splitter", "prism", "grating", "roof_mirror", "parabola")
_BENDS = ("lens", "parabola", "expander", "spatial_filter")
_TURNS = ("isolator", "polarizer", "waveplate", "wollaston")
"""Elements whose own direction about the beam is what they do to its polarization."""
_DARK = ("block", "none")
_OPEN = ("iris", "slit")
"""Elements without a surface in the light that could be dirty."""


@dataclass(frozen=True)
class Way:
    """One way in which a part changes (see `nominal.Step`): `usual`, one standard deviation from day to day; `fault`,
    one where something happened; `step`, for derivatives. `one_sided`: it only grows."""

    what: str
    unit: str
    usual: float
    fault: float
    step: float
    one_sided: bool = False


@dataclass(frozen=True)
class Cause:
    """Something that may have happened to a part, in words, by one or two ways that go together."""

    part: str
    kind: str
    ways: tuple[Way, ...]


def causes(setup: Setup, parts: Iterator[str] | tuple[str, ...]) -> tuple[Cause, ...]:
    """Return what may have happened to each of some parts."""
    return tuple(cause for name in parts for cause in _causes(setup, name))


def _causes(setup: Setup, name: str) -> Iterator[Cause]:
    kind = setup.type_of(name)
    element = kind.optics.element
    if element == "source":
        yield from _source(name)
        return
    if element in _DARK:
        return
    for tunable in _AXES:
        if zero := _zero(kind, tunable):
            yield Cause(name, f"zero of {tunable}", (zero,))
    if element == "polarizer":
        yield Cause(name, "extinction", (Way("leak", "", 0.005, 4.0, 0.05, one_sided=True),))
    if element in _STEERS:
        yield Cause(name, "turned", (_turn("yaw", 1e-4, 0.03), _turn("pitch", 1e-4, 0.03)))
    if element in (*_BENDS, *_OPEN):
        yield from _across(kind, name)
    if element in _TURNS:
        yield from _about(kind, name)
    if element == "detector":
        yield from _detector(kind, name)
    if element not in _OPEN:
        yield Cause(name, "dirt", (_dirt(),))


def _source(name: str) -> Iterator[Cause]:
    yield Cause(name, "power", (Way("power", "", 0.01, 0.2, 0.01),))
    yield Cause(name, "pointing", (_turn("yaw", 3e-4, 0.02), _turn("pitch", 3e-4, 0.02)))
    yield Cause(name, "polarization", (_turn("roll", 0.02, 3.0),))
    yield Cause(name, "dirt", (_dirt(),))


def _detector(kind: ComponentType, name: str) -> Iterator[Cause]:
    if "pixel_size" in kind.parameters or "mode_radius" in kind.parameters:
        yield Cause(name, "moved across", (_shift("left", 0.001, 0.1), _shift("up", 0.001, 0.1)))
    if "mode_radius" in kind.parameters:
        yield Cause(name, "turned", (_turn("yaw", 1e-4, 0.03), _turn("pitch", 1e-4, 0.03)))
    yield Cause(name, "gain", (Way("gain", "", 0.002, 0.1, 0.01),))
    if "dark_current" in kind.parameters:
        yield Cause(name, "dark level", (Way("dark", "electrons/s", 1.0, 200.0, 10.0, one_sided=True),))


def _across(kind: ComponentType, name: str) -> Iterator[Cause]:
    """Yield what may happen to a part that light passes off its middle."""
    yield Cause(name, "moved across", (_shift("left", 0.001, 0.1), _shift("up", 0.001, 0.1)))
    if kind.optics.element in _BENDS:
        yield Cause(name, "moved along", (_shift("ahead", 0.005, 0.5),))
        if kind.number("focal_length", "mm"):
            yield Cause(name, "focal length", (Way("focal", "", 5e-5, 0.3, 0.01),))


def _about(kind: ComponentType, name: str) -> Iterator[Cause]:
    """Yield what may happen to a part that has a direction about the beam."""
    if "angle" not in kind.tunables:
        yield Cause(name, "turned about the beam", (_turn("roll", 0.005, 3.0),))
    if kind.optics.element == "waveplate":
        yield Cause(name, "retardance", (Way("retardance", "waves", 2e-4, 0.1, 0.005),))


def _dirt() -> Way:
    return Way("loss", "", 0.002, 0.2, 0.01, one_sided=True)


def _shift(what: str, usual: float, fault: float) -> Way:
    return Way(what, "mm", usual, fault, fault / 10)


def _turn(what: str, usual: float, fault: float) -> Way:
    return Way(what, "deg", usual, fault, fault / 10)


def _zero(kind: ComponentType, tunable: str) -> Way | None:
    """Return how the zero of an axis goes astray: by what it resolves, or by a good deal when its mount slipped."""
    known = kind.tunables.get(tunable)
    if known is None or known.datatype != "float":
        return None
    fault = 1.0 if tunable == "angle" else 0.5
    return Way(ZERO + tunable, known.unit, max(known.resolution / 2, fault / 500), fault, fault / 20)
