"""What a scan keeps: a column for each tunable and each number that is measured, and in which part of it a point lies.

A scan that was cut short measures its last point again when it is taken up: where that is another by more than two
standard deviations, what follows is another part of the scan, and no curve goes through both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

APART = 2.0
"""Standard deviations of both readings from which two differ."""


def column(address: str) -> str:
    """Return the name of a column: `p1_angle`, `cam_centroid_x`, `cam_image_background_centroid_x`."""
    return re.sub(r"\W+", "_", address).strip("_")


def row(told: Mapping[str, Any]) -> dict[str, float]:
    """Return the numbers of what a measuring step told by column, standard deviations as `..._sigma`."""
    found: dict[str, float] = {}
    for address, one in told.get("measured", {}).items():
        value, sigma = one.get("value"), one.get("sigma")
        if isinstance(value, Mapping):
            named = {f"{column(address)}_{name}": (v, (sigma or {}).get(name)) for name, v in value.items()}
        else:
            named = {column(address): (value, sigma)}
        for name, (number, off) in named.items():
            if isinstance(number, int | float):
                found |= {name: float(number), f"{name}_sigma": float(off or 0.0)}
    return found


def apart(before: Mapping[str, float], again: Mapping[str, float]) -> bool:
    """Whether the same point, measured twice, is another; numbers without a standard deviation do not tell."""
    return any(
        abs(value - again[name]) > APART * math.hypot(before[f"{name}_sigma"], again[f"{name}_sigma"]) > 0
        for name, value in before.items()
        if not name.endswith("_sigma") and name in again
    )


def columns(rows: Sequence[Mapping[str, float]]) -> dict[str, list[float]]:
    """Return the columns of a scan's rows, which all have the same names."""
    return {name: [r[name] for r in rows] for name in rows[0]} if rows else {}
