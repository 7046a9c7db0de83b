"""That git merges manifests by PICO, or no longer."""

from __future__ import annotations

from typing import Any

SET = (
    "from now on git merges manifests through PICO here, and `git diff` says what moved "
    "(set once in .git/config; `pico git uninstall` takes it out)"
)


def text(*, installed: bool) -> str:
    """Return one line."""
    if installed:
        return "git merges manifests through PICO in this repository, and `git diff` says what moved."
    return "git merges and shows manifests line by line in this repository; `pico git install` sets PICO again."


def data(*, installed: bool) -> dict[str, Any]:
    """Return schema `pico.git/v1`: whether the driver is set."""
    return {"schema": "pico.git/v1", "installed": installed}
