"""What a scan keeps: a column for each tunable and each number that is measured, and in which part of it a point lies.

A scan that was cut short measures its last point again when it is taken up: where that is another by more than two
standard deviations, what follows is another part of the scan, and no curve goes through both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

from pico.expressions import Kind as ValueKind
from pico.model.setup import Setup
from pico.recipes.recipe import Name

_KINDS: Mapping[str, ValueKind] = {"float": "number", "bool": "bool", "choice": "text"}
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


def result_names(setup: Setup, address: str, numbers: Mapping[str, str]) -> dict[str, Name]:
    """Return the names that the result of a measurement has, `""` for itself; `numbers`: those of the measurable."""
    component, _, measurable = address.partition(".")
    kind = setup.measurable_of(component, measurable)
    if kind.datatype == "pose":
        return {"x": Name("number", "mm"), "y": Name("number", "mm"), "yaw": Name("number", "deg")}
    if kind.datatype == "setpoint":
        tunable = setup.type_of(component).tunables[measurable]
        return {"": Name(_KINDS[tunable.datatype], tunable.unit)}
    return _names(measurable, numbers)


def _names(measurable: str, numbers: Mapping[str, str]) -> dict[str, Name]:
    """Return how a result is called, after its name: `x`, `x_sigma`; of a single number ``, `sigma`."""
    found: dict[str, Name] = {}
    for number, unit in numbers.items():
        short = "" if number == measurable else number.removeprefix(f"{measurable}.")
        found[short] = found[f"{short}_sigma" if short else "sigma"] = Name("number", unit)
    return found
