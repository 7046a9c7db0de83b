"""The verdict of `pico doctor`; the findings themselves are diagnostics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.diagnostics import Diagnostic

from . import diagnostics
from .style import columns, count
from .version import versions


def text(found: Sequence[Diagnostic]) -> str:
    """Return the verdict, and the versions."""
    well = (
        "All is well: git knows the drivers of merge and diff, they start, the manifests are valid, "
        "and so is all that PICO keeps in .pico."
    )
    verdict = f"{count(len(found), 'thing')} to look at." if found else well
    return "\n".join([verdict, "", *columns([[name, known or "not installed"] for name, known in versions().items()])])


def data(found: Sequence[Diagnostic]) -> dict[str, Any]:
    """Return schema `pico.doctor/v1`: `well`, `versions` by name, and the diagnostics."""
    told = diagnostics.data(found)["diagnostics"]
    return {"schema": "pico.doctor/v1", "well": not found, "versions": versions(), "diagnostics": told}
