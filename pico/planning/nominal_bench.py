"""The bench as it nominally is, moved in thought: where its light passes the places that it is to come to, and how that
changes with tunables and with how parts are put down."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from pico.geometry.seat import scatter_of
from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.vocabulary import measured_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.optics.light import Light
    from pico.optics.offsets import Falling, Place

    Array = NDArray[np.float64]

Values = Mapping[str, Mapping[str, Any]]
T = TypeVar("T")
STEERS = ("tip", "tilt")
"""Tunables of a mirror that steers a beam."""
_STOPPED_DOWN = 0.6
"""The share of its widest below which an iris is closed to be aimed at."""
_STEP = 1e-3
"""Of its bounds, by which a tunable is moved to see what light does; of a standard deviation, by which a part is."""
_ALONG = 0.05
"""Of its bounds, by which a tunable along the light is moved to see how much light that costs."""


class Astray(Exception):
    """The nominal beam does not come to where it is wanted, or is not moved there by what is tuned."""


def places(setup: Setup, seen: Observation, goal: Goal) -> tuple[Place, ...]:
    """Return where light is wanted: a spatial filter that is tuned, else irises that are stopped down meanwhile, else
    a pinhole on the way, else where it is measured."""
    from pico.optics.offsets import Place

    by = frozenset(address.partition(".")[0] for address in goal.tunables)
    if filters := sorted(n for n in by if setup.type_of(n).optics.element == "spatial_filter"):
        return tuple(Place(name) for name in filters)
    irises = {}
    for address, value in ((a, v) for settings in (goal.looks or {}).values() for a, v in settings.items()):
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component)
        if kind.optics.element == "iris" and tunable == "opening" and isinstance(value, int | float):
            widest = (kind.tunables["opening"].range or (0.0, math.inf))[1]
            if value < _STOPPED_DOWN * widest:
                irises[component] = Place(component, float(value), by)
    measured = sorted({c for c, _ in measured_in(setup, goal.texts)})
    return tuple(irises.values()) or _holes(setup, seen, by, measured) or tuple(Place(n, None, by) for n in measured)


def _holes(setup: Setup, seen: Observation, by: frozenset[str], measured: Sequence[str]) -> tuple[Place, ...]:
    """Return the pinholes between what is tuned and where it is measured."""
    from pico.optics.axis import beams
    from pico.optics.offsets import Place

    found = dict[str, Place]()
    for axis in beams(setup, _standing(setup, seen), {n: _open(own) for n, own in seen.known_values.items()}):
        for way in (w for n in measured for w in axis.ways(n)):
            names = [m.component for m in way]
            start = max((names.index(n) for n in by if n in names), default=len(names))
            for name in names[start:-1]:
                kind = setup.type_of(name) if name else None
                if kind and kind.optics.element == "iris" and "opening" not in kind.tunables:
                    found[name] = Place(name, None, by)
    return tuple(found.values())


def _standing(setup: Setup, seen: Observation) -> dict[str, Pose]:
    return {n: p.pose for n, p in seen.components.items()
            if p.presence == "seen" and p.pose is not None and n in setup.lab.inventory}  # fmt: skip


class NominalBench:
    """A bench as seen, whose parts can be moved in thought: with all light on, and irises and shutters open. `offsets`:
    of its light at all places, one after the other; `lost`: whether that comes there only as mirrors were meant. Raises
    Astray where light does not come to one of them."""

    def __init__(self, setup: Setup, seen: Observation, ends: Sequence[Place]) -> None:
        from pico.optics.nominal.bench import Nominal

        values = {name: _open(own) for name, own in seen.known_values.items()}
        self.places, self.thought = ends, Nominal(setup, _standing(setup, seen), values)
        self.light, self.lost = self.thought.light(), False
        try:
            self.offsets = self._offsets(self.light)
        except Astray:  # what its mirrors make up for is not seen: as they were meant, it comes there
            self.thought, self.lost = replace(self.thought, values=straight(values)), True
            self.light = self.thought.light()
            self.offsets = self._offsets(self.light)

    def _offsets(self, light: Light) -> Array:
        import numpy as np

        from pico.optics.offsets import offset

        return np.concatenate([_there(offset(light, place)) for place in self.places])

    def falling(self, light: Light | None = None) -> list[Falling]:
        """Return how the power of the light falls with the offsets at each place; of another light, if given."""
        from pico.optics.offsets import falling

        return [_there(falling(light or self.light, place)) for place in self.places]

    def moved_by(self, address: str, bounds: tuple[float, float]) -> Array:
        """Return by how much the offsets change with a unit of a tunable."""
        step = _STEP * (bounds[1] - bounds[0])
        if self.value(address) + step > bounds[1]:
            step = -step
        return (self._offsets(self.thought.set_to(address, step).light()) - self.offsets) / step

    def along(self, address: str, bounds: tuple[float, float], many: int) -> tuple[float, float, float]:
        """Return how the logarithm of the power at its best, at the first `many` places, falls with a tunable along the
        light, how far its top is, and the variance of that by how parts scatter along it; raises Astray where it has no
        top."""
        (low, high), here = bounds, self.value(address)
        step = _ALONG * (high - low)
        before, middle, after = (
            sum(math.log(f.power) for f in self.falling(self.thought.set_to(address, by).light())[:many])
            for by in (-step, 0.0, step)
        )
        bend = (2 * middle - before - after) / (2 * step**2)
        if bend <= 0:
            raise Astray
        shift = min(high, max(low, here + (after - before) / (4 * step * bend))) - here
        scatter = [
            scatter_of(self.thought.setup, n).x for n in (_part(address), *(p.component for p in self.places[:many]))
        ]
        return bend, shift, sum(x**2 for x in scatter)

    def slopes(self, wanted: Sequence[str], addresses: Iterable[str]) -> Array:
        """Return by how much numbers, a row each, change with a unit of tunables; (0, 0) where one is not told."""
        import numpy as np

        places = [name.replace(".fit.", ".centroid.") for name in wanted]  # a Gaussian's middle is its centroid
        columns = [self.thought.by_tunable(places, address) for address in addresses] if wanted else []
        known = [column for column in columns if column is not None]
        return np.stack(known, axis=1) if known and len(known) == len(columns) else np.zeros((0, 0))

    def scattered(self) -> Array:
        """Return by how much the offsets change with one standard deviation of each placement, one a column; of parts
        that an arm puts down, as others stand as they did; of all where it puts none down."""
        import numpy as np

        from pico.optics.nominal.bench import PLACED

        setup, columns = self.thought.setup, [np.zeros(len(self.offsets))]
        met = sorted({c.component for c in self.light.crossings} & self.thought.poses.keys())
        for name in [n for n in met if setup.movable(n)] or met:
            one = scatter_of(setup, name)
            for way in PLACED:
                there = self.thought.put(name, way, _STEP * getattr(one, way))
                columns.append((self._offsets(there.light()) - self.offsets) / _STEP)
        return np.stack(columns, axis=1)

    def value(self, address: str) -> float:
        """Return what a tunable is at: as seen, or as it was meant where only that brings light there."""
        return float(self.thought.values.get(_part(address), {}).get(address.partition(".")[2], 0.0))


def straight(values: Values) -> Values:
    """Return tunables with mirrors that are not turned."""
    return {n: {k: 0.0 if k in STEERS else v for k, v in own.items()} for n, own in values.items()}


def _part(address: str) -> str:
    return address.partition(".")[0]


def _there(found: T | None) -> T:
    if found is None:
        raise Astray
    return found


def _open(own: Mapping[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in own.items() if k not in ("opening", "shutter", "emission", "exposure")}
