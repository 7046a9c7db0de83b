"""What was measured, in a line."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from pico.kernels.measured import in_order
from pico.model.measurement import Measurement

from .style import number, paint

_POWERS = (("W", 1e-3), ("mW", 1.0), ("uW", 1e3), ("nW", 1e6), ("pW", 1e9))
_SMALL = ("V", "A")
"""Units of which small numbers are shown with a prefix."""
_PREFIXES = (("", 1.0), ("m", 1e3), ("u", 1e6), ("n", 1e9), ("p", 1e12))
_MILLIWATTS = {unit: 1 / scale for unit, scale in _POWERS}


def line(found: Mapping[str, Any]) -> str:
    """Return value, unit and array of a measurement (as JSON), and what of it was not assured."""
    parts = [value(in_order(found.get("kernel"), found.get("value")), found.get("unit", ""), found.get("sigma"))]
    if found.get("unknown"):
        parts = [paint("yellow", f"unknown: {found['unknown']}")]
    if array := found.get("array"):
        shape = " x ".join(str(n) for n in array["shape"])
        parts.append(f"array {shape} {array['dtype']} {array['sha256'][:12]}")
    doubts = "; ".join(f"{what} ({why})" for what, why in found.get("not_assured", {}).items())
    return ", ".join(part for part in parts if part) + (paint("yellow", f", not assured: {doubts}") if doubts else "")


def numbers(found: Measurement) -> list[dict[str, Any]]:
    """Return what was measured as JSON, each number with its own unit: `name`, `value`, `sigma`, `unit`."""
    return [{"name": n, "value": v, "sigma": s, "unit": unit} for n, (v, s, unit) in found.numbers.items()]


def value(found: Any, unit: str = "", sigma: Any = None) -> str:
    """Return `x 520 mm, yaw 30 deg`, or what it is; `unit`: one for all, or one for each name; `sigma`: one standard
    deviation, as the value."""
    unit = "" if unit == "1" else unit
    if isinstance(found, Mapping):
        units = unit.split(", ")
        each = units if len(units) == len(found) else [unit] * len(found)
        spread = sigma if isinstance(sigma, Mapping) else {}
        return ", ".join(
            f"{name} {value(one, of, spread.get(name))}" for (name, one), of in zip(found.items(), each, strict=True)
        )
    if isinstance(found, bool):
        return str(found).lower()
    if isinstance(found, int | float) and unit in _MILLIWATTS:
        return power(found * _MILLIWATTS[unit], None if sigma is None else float(sigma) * _MILLIWATTS[unit])
    if isinstance(found, int | float) and unit in _SMALL and 0 < max(abs(found), sigma or 0.0) < 0.1:
        return _scaled(found, sigma, [(f"{prefix}{unit}", scale) for prefix, scale in _PREFIXES])
    if isinstance(found, int | float) and isinstance(sigma, int | float) and sigma > 0:
        digits = max(0, 1 - math.floor(math.log10(sigma)))
        said = f"{found:.{digits}f}"
        said = said.removeprefix("-") if float(said) == 0 else said
        return f"{said} ± {sigma:.{digits}f} {unit}".strip()
    said = number(found, 3) if isinstance(found, int | float) else str(found or "")
    return f"{said} {unit}".strip()


def power(found: float, sigma: float | None = None) -> str:
    """Return a power [mW], with one standard deviation, in the unit in which it reads best: `1.205 mW ± 0.012 mW`,
    `0.5 nW ± 1.0 nW`."""
    return _scaled(found, sigma, _POWERS)


def _scaled(found: float, sigma: float | None, units: Sequence[tuple[str, float]]) -> str:
    """Return a number in the unit in which it reads best; `units`: each with its factor, the largest unit first."""
    size = max(abs(found), sigma or 0.0)
    unit, scale = next(((u, s) for u, s in units if size * s >= 0.1), units[-1])
    if not sigma:
        return f"{found * scale:.3g} {unit}"
    digits = max(0, 1 - math.floor(math.log10(sigma * scale)))
    said = f"{found * scale:.{digits}f}"
    said = said.removeprefix("-") if float(said) == 0 else said
    return f"{said} {unit} ± {sigma * scale:.{digits}f} {unit}"


def ranged(data: Mapping[str, Any]) -> str:
    """Return the exposure that was found, and in how many frames; empty for any other operation."""
    frames = data.get("frames")
    if not frames or not isinstance(data.get("value"), int | float):
        return ""
    return f"{number(data['value'], 3)} ms, found in {len(frames)} frame{'' if len(frames) == 1 else 's'}"


def solved(data: Mapping[str, Any]) -> str:
    """Return where an optimization left a tunable by an offset from the best of its model: `p2.angle 180.82, from the
    best at 179.8231 ± 0.0016`; empty for any other operation."""
    found, last = data.get("solution"), data.get("last")
    if not isinstance(found, Mapping) or not isinstance(last, Mapping):
        return ""
    places = [name for name in found if not name.endswith("_sigma") and name in last]
    return ", ".join(
        f"{name} {number(last[name], 4)}, from the best at {value(found[name], '', found.get(f'{name}_sigma'))}"
        for name in places
    )
