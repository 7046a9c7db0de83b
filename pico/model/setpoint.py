"""Set-points: how long a tunable takes to its value, which values it takes, and how a person writes one."""

from __future__ import annotations

import math
import re

from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.catalog import Tunable
from pico.model.diff import value_distance
from pico.model.quantities import QuantityError, Value, convert

STEP = re.compile(r"\s*([-+])=\s*(.*)")
"""A step from the present value: `+=5`, `-= 2 mrad`."""
_FINE = 9
"""Digits after the point that a sum keeps: 0.1 + 0.2 is 0.3, and a step back leads to the number of before."""
_TURN = 360.0
_ANGLES = ("deg", "°", "rad", "mrad")


def set_seconds(kind: Tunable, before: Value | None, after: Value) -> float:
    """Return how long it takes [s] to bring a tunable from `before` (None where unknown) to `after`.

    An axis travels the shorter way at its speed; from an unknown value it may have its whole range to go. Then the
    value settles.
    """
    settle = kind.settle / 1000
    if kind.axis is None or kind.axis.speed <= 0:
        return settle
    return _travel(kind, before, after) / kind.axis.speed + settle


def home_seconds(kind: Tunable, before: Value | None) -> float:
    """Return how long it takes [s] to bring the axis of a tunable from `before` (None where unknown) to its home."""
    return set_seconds(kind, before, kind.axis.home if kind.axis else 0.0)


def _travel(kind: Tunable, before: Value | None, after: Value) -> float:
    if before is None:
        return kind.range[1] - kind.range[0] if kind.range else kind.period or 0.0
    way = value_distance(kind, before, after)
    return way if math.isfinite(way) else 0.0


def refusal(kind: Tunable, value: object) -> str:
    """Return why a tunable does not take `value`, in words that follow its name; empty where it does."""
    if kind.datatype == "bool":
        return "" if isinstance(value, bool) else f"is true or false, not {value!r}"
    if kind.datatype == "choice":
        return "" if value in kind.choices else f"is one of {', '.join(kind.choices)}, not {value!r}"
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return f"is a number, not {value!r}"
    if kind.range and not kind.range[0] <= value <= kind.range[1]:
        return f"goes from {kind.range[0]:g} to {kind.range[1]:g} {kind.unit}".rstrip() + f", not to {value:g}"
    return ""


def canonical(kind: Tunable, value: float) -> float:
    """Return a number as a tunable takes it: one up to a turn beyond its range as the one within that is equivalent to
    it (400 deg is 40, -10 is 350), any other as it is. Further away it is more likely a slip."""
    if not kind.period or kind.range is None or kind.range[0] <= value <= kind.range[1]:
        return value
    low, high = kind.range
    turn = float(convert(f"{_TURN:g} deg", kind.unit)) if kind.unit in _ANGLES else kind.period
    if not low - turn <= value <= high + turn:
        return value
    cycles = (turn, kind.period) if math.isclose(turn / kind.period, round(turn / kind.period)) else (kind.period,)
    found = (round(low + (value - low) % cycle, _FINE) for cycle in cycles)
    return next((within for within in found if low <= within <= high), value)


def stepped(base: float, step: float) -> float:
    """Return a number and a step from it, without the last digits that binary fractions leave: steps add up, and a step
    back leads back."""
    return round(base + step, _FINE)


def read_value(component: str, name: str, kind: Tunable, text: str, base: Value | None = None) -> Value:
    """Return a tunable's value from how a person writes it: a value, or a step (`+=5`) from `base`, None for unknown.

    An angle that is equivalent to one in range counts as that one. Raises PicoError for another type, unit or range,
    and for a step from nowhere.
    """
    subject = f"{name} of {component}"
    step = STEP.fullmatch(text)
    if step and kind.datatype != "float":
        raise wrong(f"{subject} is no number, so `{text}` is no step of it", f"`{name}=VALUE`", component)
    if kind.datatype == "bool":
        if text not in ("true", "false"):
            raise wrong(f"{subject} is true or false, not `{text}`", "", component)
        return text == "true"
    if kind.datatype == "choice":
        if text not in (kind.choices or ()):
            raise wrong(f"{subject} has no choice `{text}`", did_you_mean(text, kind.choices or ()), component)
        return text
    value = read_quantity(subject, step[2] if step else text, kind.unit)
    if step:
        if isinstance(base, bool | str) or base is None:
            hint = f"give a value: `{name}=VALUE`"
            raise wrong(f"the value of {subject} is unknown, so `{text}` leads nowhere", hint, component)
        value = stepped(base, value if step[1] == "+" else -value)
    value = canonical(kind, value)
    if kind.range and not kind.range[0] <= value <= kind.range[1]:
        low, high = kind.range
        raise wrong(f"{subject} goes from {low:g} to {high:g} {kind.unit}, not to {value:g}", "", component)
    return value


def read_quantity(subject: str, text: str, unit: str) -> float:
    """Return a finite number in `unit` from how a person writes it; raises PicoError."""
    try:
        value = float(text)
    except ValueError:
        try:
            value = float(convert(text, unit))
        except QuantityError as exc:
            raise wrong(f"{subject}: {exc}", "") from exc
    if not math.isfinite(value):
        raise wrong(f"{subject} must be a finite number", "")
    return value


def wrong(summary: str, hint: str, address: str = "") -> PicoError:
    """Return what is wrong with what a person asks for."""
    return PicoError(error("request", summary, hint=hint, address=address))
