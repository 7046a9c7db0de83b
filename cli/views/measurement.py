"""A measurement: a line for each number, what it was taken with, what was left out of it, and what was not assured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.diagnostics import Diagnostic
from pico.model.measurement import Measurement
from pico.model.record import as_json

from .measured import value
from .style import columns, paint, wrap

_SETTINGS = {"exposure": "ms", "gain": "dB"}


def text(found: Measurement, *, run: str, advice: str = "", diagnostics: Sequence[Diagnostic] = ()) -> str:
    """Return the numbers with their standard deviations, and how they came about; `advice`: what to do about
    it. `diagnostics` are shown beside it."""
    if found.unknown:
        lines = wrap(f"{found.address}  {paint('yellow', 'unknown')}: {found.unknown}", "")
    elif isinstance(found.value, Mapping):
        lines = [found.address, *(f"  {row}" for row in columns(_rows(found)))]
    else:
        lines = [f"{found.address}  {value(found.value, found.unit, found.sigma)}"]
    if found.array:
        shape = " x ".join(str(n) for n in found.array.shape)
        lines.append(f"  {shape} {found.array.dtype}, kept as {found.array.sha256[:12]}")
    made = f"`{found.kernel}` version {found.kernel_version}, " if found.kernel else ""
    given = {k: found.settings[k] for k in _SETTINGS if k in found.settings}
    units = {k: "" if isinstance(v, str) else _SETTINGS[k] for k, v in given.items()}  # `0 dB` has its own
    setting = ", ".join(f"{k} {value(v, units[k])}" for k, v in given.items())
    lines += wrap(f"{made}{setting + ', ' if setting else ''}`pico runs show {run}`", "  ")
    lines += wrap(found.remark, "  ") if found.remark else []
    for what, why in found.not_assured.items():
        lines += wrap(paint("yellow", f"not assured: {what} ({why})"), "  ")
    lines += wrap(f"= help: {advice}", "  ") if advice else []
    return "\n".join(lines)


def _rows(found: Measurement) -> list[list[str]]:
    return [[name, value(one, unit, sigma)] for name, (one, sigma, unit) in found.numbers.items()]


def data(
    found: Measurement, *, run: str, advice: str = "", diagnostics: Sequence[Diagnostic] = ()
) -> dict[str, Any]:  # fmt: skip
    """Return the measurement, schema `pico.measurement/v1`, with the `run` that took it, and the `diagnostics`."""
    return {**as_json(found), "run": run, **({"diagnostics": as_json(tuple(diagnostics))} if diagnostics else {})}
