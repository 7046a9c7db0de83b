"""Where the page of a lab is."""

from __future__ import annotations

from typing import Any


def text(address: str, lab: str, opened: bool) -> str:
    """Return where the page is, and whether a browser was `opened`."""
    first = f"{lab} is in the browser:" if opened else f"Open {lab} in a browser on this machine:"
    return f"{first}\n  {address}\nThis link works once. Ctrl-C stops the server."


def data(address: str, lab: str, opened: bool) -> dict[str, Any]:
    """Return schema `pico.gui/v1`: `address`, `lab`, `opened`."""
    return {"schema": "pico.gui/v1", "address": address, "lab": lab, "opened": opened}
