"""What an instrument's reply says: a number with its unit, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from pico.base.reasons import REASONS, ReasonCode
from pico.model.quantities import Value
from pico.model.record import record


@record
class Readout:
    """One number as an instrument gave it. Exactly one of `value` and `unknown` is None."""

    unit: str
    """The unit of `value`, as the driver declares it."""
    value: Value | None = None
    """The number; a driver of named positions gives a word, one of a switch a truth value."""
    sigma: float | None = None
    """One standard deviation of `value`, None if the instrument does not give it."""
    unknown: ReasonCode | None = None
    """Why there is no value."""
    why: str = ""
    """The same in words, with the numbers."""
    raw: str = ""
    """The reply as it came over the wire."""
    settings: Mapping[str, Value] = field(default_factory=dict)
    """What was read back with it and the number depends on, such as the `wavelength` [nm]."""

    def __post_init__(self) -> None:
        if (self.value is None) == (self.unknown is None):
            raise ValueError("a readout has a value, or a reason why it has none")

    @property
    def number(self) -> float | None:
        """The value as a number; None if it is unknown."""
        return None if self.value is None or isinstance(self.value, str) else float(self.value)


def unknown(unit: str, code: ReasonCode, raw: str = "", why: str = "") -> Readout:
    """Return a readout without a value; `why`: in words, by default what the code means."""
    return Readout(unit=unit, unknown=code, why=why or REASONS[code], raw=raw)


def shown(found: Readout) -> str:
    """Return a readout in words: its value with unit and sigma, or why it is unknown."""
    if found.value is None:
        return f"unknown: {found.why}"
    if isinstance(found.value, str | bool):
        return str(found.value)
    sigma = f" ± {found.sigma:.2g} {found.unit}".rstrip() if found.sigma is not None else ""
    return f"{found.value:.4g} {found.unit}".rstrip() + sigma
