"""Which bench commands mean."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pico.edge.network.remotes import Far


def text(far: Far | None) -> str:
    """Return which bench it is, and how another one is said."""
    if far is None:
        return "Commands mean the bench of this checkout."
    return f"Commands mean {far.said}; `--bench local` means the bench of this checkout."


def data(far: Far | None) -> dict[str, Any]:
    """Return schema `pico.meant/v1`: `bench` and the `url` of its coordinator, or none."""
    return {"schema": "pico.meant/v1", "bench": far.name if far else None, "url": far.remote.url if far else None}
