"""The verdict of `pico validate`; the findings themselves are diagnostics."""

from __future__ import annotations

from typing import Any

from pico.manifest.folders import FolderVerdict

from . import diagnostics
from .style import count


def text(checked: FolderVerdict) -> str:
    """Return one line."""
    errors = sum(d.severity == "error" for d in checked.diagnostics)
    if errors:
        return f"Checked {count(checked.files, 'file')}: not valid."
    if not checked.lab:
        return "No manifest is among these files."
    what = f"{count(checked.files, 'file')}, {count(checked.parts, 'part')}"
    return f"{checked.lab}: the manifests are valid ({what})."


def data(checked: FolderVerdict) -> dict[str, Any]:
    """Return schema `pico.validation/v1`: `valid`, counts and diagnostics."""
    return {
        "schema": "pico.validation/v1", "valid": checked.exit_code == 0, "lab": checked.lab, "files": checked.files,
        "parts": checked.parts, "diagnostics": diagnostics.data(checked.diagnostics)["diagnostics"],
    }  # fmt: skip
