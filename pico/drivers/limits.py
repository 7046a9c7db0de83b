"""What a lab allows of a device, kept where it is driven."""

from __future__ import annotations

import math

from pico.diagnostics import PicoError, error


def require_within(name: str, what: str, value: float, limits: tuple[float, float], unit: str) -> None:
    """Raise PicoError for a value of a device's property that is not within its limits."""
    low, high = limits
    if not (math.isfinite(value) and low <= value <= high):
        text = f"{name} is not to have {what} {value:g} {unit}: its limits are {low:g} to {high:g} {unit}"
        raise PicoError(error("device-limit", text, hint="`limits` of the device says so", address=name))
