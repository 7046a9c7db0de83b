"""What plug-ins let the simulator do: a function for each primitive, by the entry point `pico.sim.primitives`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

from pico.backends.attempt import Failed
from pico.backends.sim.world import World
from pico.model.operation import Operation
from pico.plug_ins.calling import Interface, Loading, function, instance

GROUP = "pico.sim.primitives"

Simulated = Callable[[World, Operation], World]
"""Returns the world as it is when the operation is done; raises `Failed` (of `pico.backends.attempt`)."""


INTERFACE = Interface(GROUP, {"": function}, {"": instance(World)}, lets=(Failed,))


@cache
def plugged_in() -> Mapping[str, Simulated]:
    """Return how the primitives of plug-ins are simulated, by name, each loaded when it is asked for."""
    return Loading(INTERFACE)
