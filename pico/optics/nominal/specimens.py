"""What the glass of a bench leaves open: light as it is where a measured number of a part is one standard deviation
more."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from pico.model.catalog import value_of
from pico.model.quantities import convert
from pico.model.setup import Setup
from pico.optics.light import Light


def uncertain(setup: Setup, light: Light, trace: Callable[[Setup], Light]) -> dict[int, tuple[float, float, float]]:
    """Return by the number of a crossing one standard deviation of the beam there: its larger and smaller radius [mm]
    and its power [mW], to first order in what was measured of parts; nothing where no sigma is said. Beams that go
    another way then are left out."""
    squares: dict[int, tuple[float, float, float]] = {}
    met = {c.component for c in light.crossings} | {c.beam.source for c in light.crossings}
    for other in _more(setup, met):
        there = trace(other).crossings
        for number, crossing in enumerate(light.crossings):
            if number < len(there) and there[number].component == crossing.component:
                one, two = crossing, there[number]
                was, now = ((*c.beam.widths[:2], c.power) for c in (one, two))
                by = tuple(a - b for a, b in zip(now, was, strict=True))
                before = squares.get(number, (0.0, 0.0, 0.0))
                squares[number] = (before[0] + by[0] ** 2, before[1] + by[1] ** 2, before[2] + by[2] ** 2)
    return {n: (math.sqrt(a), math.sqrt(b), math.sqrt(c)) for n, (a, b, c) in squares.items()}


def _more(setup: Setup, met: set[str]) -> Iterator[Setup]:
    """Yield the bench with each number of a part that was measured one standard deviation more."""
    for name in sorted(met & setup.lab.inventory.keys()):
        part, kinds = setup.lab.inventory[name], setup.catalog[setup.lab.inventory[name].type].parameters
        for number, known in (part.measured or {}).items():
            if known.sigma is None or part.parameters is None or number not in part.parameters:
                continue
            value = value_of(kinds[number], part.parameters[number])
            if not isinstance(value, int | float) or not (sigma := float(convert(known.sigma, kinds[number].unit))):
                continue
            more = replace(part, parameters={**part.parameters, number: value + sigma})
            yield replace(setup, lab=replace(setup.lab, inventory={**setup.lab.inventory, name: more}))
