"""What kernels make of pictures from disk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.kernels.kernel import Result

from .measured import value
from .style import columns, paint, wrap

Row = tuple[str, str, Result]
"""The file or the series, the kernels, and what they make of it."""


def text(rows: Sequence[Row], unit: str) -> str:
    """Return a paragraph for each file and row of kernels; `unit`: um, or px if the size of a pixel is unknown."""
    lines: list[str] = []
    for name, kernels, found in rows:
        lines += [f"{name}  {kernels}"]
        if found.unknown:
            lines += wrap(f"{paint('yellow', 'unknown')}: {found.unknown}", "  ")
        else:
            own = _units(found, unit)
            lines += [
                f"  {r}" for r in columns([[n, value(v, own[n], found.sigma[n])] for n, v in found.value.items()])
            ]
        lines += wrap(found.remark, "  ") if found.remark else []
    return "\n".join(lines)


def data(rows: Sequence[Row], unit: str) -> dict[str, Any]:
    """Return schema `pico.pictures/v1`: for each file and row of kernels the numbers, or why they are unknown."""
    return {
        "schema": "pico.pictures/v1",
        "measured": [
            {
                "picture": name, "kernel": kernels, "kernel_version": found.version,
                "value": dict(found.value) or None, "sigma": dict(found.sigma) or None, "unit": _units(found, unit),
                "unknown": found.unknown or None, "remark": found.remark,
            }
            for name, kernels, found in rows
        ],
    }  # fmt: skip


def _units(found: Result, unit: str) -> Mapping[str, str]:
    """The units of the numbers: lengths on the sensor in `unit`; of light only counts, for the exposure is unknown."""
    own = {"um": unit, "count/ms": "count"}
    return {name: own.get(one, one) for name, one in found.units.items()}
