"""Set-points: how long a tunable takes to its value, and which values it takes."""

from __future__ import annotations

import math

from pico.model.catalog import Tunable
from pico.model.diff import value_distance
from pico.model.quantities import Value


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
