"""Which bench commands mean."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.edge.network.meant import word_for
from pico.edge.network.remotes import Far, Place

from .benches import line
from .style import columns

if TYPE_CHECKING:
    from pico.history.runs.benches import BenchState


def text(place: Place, state: BenchState | None) -> str:
    """Return which bench it is, and what it holds (`state`, of one of this machine)."""
    first = f"Commands in this worktree now mean {place.said}; `--bench NAME` means another one for one command."
    return first if state is None else "\n".join([first, *columns([line(state, meant=True)])])


def data(place: Place, state: BenchState | None) -> dict[str, Any]:
    """Return schema `pico.meant/v1`: `bench` as `--bench` takes it, and the `url` of its coordinator, null for none."""
    return {
        "schema": "pico.meant/v1", "bench": word_for(place), "url": place.remote.url if isinstance(place, Far) else None
    }  # fmt: skip
