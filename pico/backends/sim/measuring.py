"""A measurement of the simulated table, with what was assured while it was taken."""

from __future__ import annotations

from collections.abc import Sequence

from pico.backends.attempt import Failed
from pico.backends.measured import measurement
from pico.backends.sim.checks import not_simulated
from pico.backends.sim.readings import Measurer, Table, measurer_of
from pico.backends.sim.world import World, observe
from pico.diagnostics import PicoError
from pico.model.catalog import Measurable
from pico.model.measurement import Measurement
from pico.model.setup import Setup
from pico.places.bench import BenchPlace


def require_simulated(setup: Setup, component: str, name: str) -> tuple[Measurable, Measurer]:
    """Return a measurable, and what reads it; raises `Failed` where it is not simulated."""
    try:
        known = setup.measurable_of(component, name)
    except PicoError as exc:
        raise Failed(exc.diagnostics[0] if "|" in name else not_simulated(component, name)) from exc
    measurer = measurer_of(setup, component, name)
    if measurer is None:
        raise Failed(not_simulated(component, name))
    return known, measurer


def measured(
    setup: Setup, place: BenchPlace, world: World, component: str, name: str, busy: Sequence[str] | None, at: str,
    light: World | None = None,
) -> Measurement:  # fmt: skip
    """Return what is measured of `component` on the table as it is; an array goes to the content store.

    `busy`: the operations under way beside it; None where it is only peeked at. `at`: now, as ISO 8601. `light`: the
    table as its light is, where that is another. Raises `Failed` where it is not simulated or can't be read now,
    PicoError where an array can't be kept.
    """
    known, measurer = require_simulated(setup, component, name)
    reading = measurer.read(Table(setup, place, light or world), component, name)
    seen = observe(world, "sim", "")
    return measurement(setup, place.root, seen, known, reading, component, name, busy, at)
