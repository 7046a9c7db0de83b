"""What plug-ins let the simulator do: a function for each primitive, by the entry point `pico.sim.primitives`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

from pico.backends.sim.world import World
from pico.model.operation import Operation

GROUP = "pico.sim.primitives"

Simulated = Callable[[World, Operation], World]
"""Returns the world as it is when the operation is done; raises `Failed` (of `pico.backends.attempt`)."""


@cache
def plugged_in() -> Mapping[str, Simulated]:
    """Return how the primitives of plug-ins are simulated, by name."""
    from importlib.metadata import entry_points

    return {entry.name: entry.load() for entry in entry_points(group=GROUP)}
