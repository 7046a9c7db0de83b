"""What the simulator reads of its table. Each measurable is a file in FOLDER, found by being there: it says what it
`measures`, and `read`s it, see `Measurer`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Protocol, cast

from pico.backends.measured import Reading
from pico.backends.sim.world import World
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

FOLDER = "pico.backends.sim.measurables"


@dataclass(frozen=True)
class Table:
    """The simulated table of the bench at `place` at the moment of a measurement."""

    setup: Setup
    place: BenchPlace
    world: World

    @property
    def root(self) -> Path:
        """The folder of the lab."""
        return self.place.root


class Measurer(Protocol):
    """A file of FOLDER."""

    def measures(self, setup: Setup, component: str, measurable: str) -> bool:
        """Return whether this is where a measurable of a component or camera is read; imports nothing heavy."""
        ...

    def read(self, table: Table, component: str, measurable: str) -> Reading:
        """Read it; raises `Failed` (of `pico.backends.attempt`) where that can't be now."""
        ...


def measurers() -> list[Measurer]:
    """Return the files that are there."""
    names = [found.name for found in iter_modules(import_module(FOLDER).__path__)]
    return [cast(Measurer, import_module(f"{FOLDER}.{name}")) for name in names]


def measurer_of(setup: Setup, component: str, measurable: str) -> Measurer | None:
    """Return what reads a measurable; None where it is not simulated."""
    return next((m for m in measurers() if m.measures(setup, component, measurable)), None)


def simulated(setup: Setup) -> Iterator[str]:
    """Yield what of a bench can be measured, as addresses: `p2.pose`, `p1.angle`, `left.frame`."""
    known = measurers()
    for name in (*setup.lab.inventory, *setup.lab.cameras):
        for measurable in setup.measurables_of(name):
            if any(m.measures(setup, name, measurable) for m in known):
                yield f"{name}.{measurable}"
