"""Between a number of a device and the lab's: units, sign, scale and offset, and angles by whole turns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from math import ceil

from pico.model.quantities import QuantityError, convert, dimension
from pico.model.record import record
from pico.model.wiring import Wired

_TURN = "360 deg"
_MARGIN = 1e-9
"""How far beyond a limit a converted number may lie and is that limit nevertheless [of the limit's unit]."""


@record
class Conversion:
    """How the number of a device's property becomes the lab's, and back."""

    wired: Wired
    """What the lab's files say of it, `unit` filled in."""
    own: str = ""
    """The unit of the device's number, '' if the driver declares none."""
    unit: str = ""
    """The unit of the lab's number."""
    limits: tuple[float, float] | None = None
    """What the device may be told, in its own unit; None if nothing limits it."""
    range: tuple[float, float] | None = None
    """The range of the tunable, in the lab's unit."""
    period: float | None = None
    """After how much the tunable is the same again, in the lab's unit."""

    @property
    def _turn(self) -> float:
        """A full turn in the device's unit, 0 if its number is no angle."""
        return float(convert(_TURN, self.own)) if _is_angle(self.own) else 0.0

    def to_device(self, value: float) -> float:
        """Return the device's number for one of the lab's. An angle that the limits exclude becomes the same angle
        within them: by whole turns, or else by the period of the tunable."""
        at = self.wired.to_device(value, self.unit)
        if self.limits is None or not self._turn:
            return at
        low, high = self.limits
        steps = [0.0, self._turn]
        if self.period is not None:
            steps.append(abs(self.wired.to_device(self.period, self.unit) - self.wired.to_device(0.0, self.unit)))
        for one in chain.from_iterable(_shifted(at, low, step) for step in steps):
            if low - _MARGIN <= one <= high + _MARGIN:
                return min(max(one, low), high)
        return at

    def reaches(self, value: float) -> bool:
        """Return whether the device may be told what one of the lab's numbers becomes."""
        if self.limits is None:
            return True
        low, high = self.limits
        return low - _MARGIN <= self.to_device(value) <= high + _MARGIN

    def to_lab(self, value: float) -> float:
        """Return the lab's number for one of the device's; an angle beyond the range of the tunable as the same angle
        within it, if there is one by whole turns."""
        found = self.wired.to_lab(value, self.unit)
        if self.range is None or not self._turn or not _is_angle(self.unit):
            return found
        low, high = self.range
        for one in _shifted(found, low, float(convert(_TURN, self.unit))):
            if low <= one <= high:
                return one
        return found

    def spread(self, sigma: float) -> float:
        """Return one standard deviation of the lab's number for one of the device's."""
        return abs(self.wired.to_lab(sigma, self.unit) - self.wired.to_lab(0.0, self.unit))


def _shifted(value: float, low: float, step: float) -> Iterator[float]:
    """Yield a number as it is, and the least one from `low` on that differs from it by whole steps."""
    yield value
    if step:
        yield value + ceil((low - _MARGIN - value) / step) * step


def conversion(
    wired: Wired, own: str, unit: str, *, limits: tuple[float, float] | None = None,
    range: tuple[float, float] | None = None, period: float | None = None,
) -> Conversion:  # fmt: skip
    """Return how a property in `own` becomes a tunable or measurable in `unit`; for the rest see `Conversion`."""
    said = wired.unit or (own if own and unit and same_dimension(own, unit) else unit)
    return Conversion(
        wired=replace(wired, unit=said or None), own=own, unit=unit, limits=limits, range=range, period=period
    )


def same_dimension(one: str, other: str) -> bool:
    """Whether numbers in one unit can be converted into another; False for a unit that is unknown."""
    try:
        return one == other or dimension(one) == dimension(other)
    except QuantityError:
        return False


def _is_angle(unit: str) -> bool:
    return bool(unit) and same_dimension(unit, "deg")
