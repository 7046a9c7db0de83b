"""The parts list of a drawing: what each component is, what is fixed about it, and where it stands."""

from __future__ import annotations

from collections.abc import Mapping

from pico.model.catalog import ComponentType, Parameter
from pico.model.pose import Pose, short
from pico.model.setup import Setup

HEAD = ("name", "type", "data", "x / mm", "y / mm", "yaw / °", "marker")
NUMBERS = (3, 4, 5, 6)
"""Columns of numbers."""
_SYMBOLS = {"focal_length": "f", "wavelength": "λ", "beam_waist": "w0", "transmission": "T", "reflectivity": "R"}
_MOST = 3


def rows(setup: Setup, poses: Mapping[str, Pose]) -> list[tuple[str, ...]]:
    """Return a row for each component, in the order of x along the table; cells as `HEAD` names them."""
    found: list[tuple[str, ...]] = []
    for name, pose in sorted(poses.items(), key=lambda item: (round(item[1].x, 1), item[1].y, item[0])):
        part, kind = setup.lab.inventory[name], setup.type_of(name)
        marker = "" if part.marker is None else str(part.marker)
        found.append((name, kind.title, _data(kind), short(pose.x), short(pose.y), short(pose.yaw), marker))
    return found


def _data(kind: ComponentType) -> str:
    """`f = 125 mm, ...`: the fixed parameters that have a unit, the first few."""
    found = [f"{_SYMBOLS.get(n, n.replace('_', ' '))} = {_value(p)}" for n, p in kind.parameters.items()]
    known = sorted(found, key=lambda words: words.split(" = ")[0] not in _SYMBOLS.values())
    return ", ".join(known[:_MOST])


def _value(parameter: Parameter) -> str:
    value = parameter.value
    text = f"{value:g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
    return f"{text} {parameter.unit}".strip()
