"""What the ray model says that changes of parts do to the quantities of a bench, and what instruments show of it: in
the dark a meter reads no less than its noise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.curves import Curve, bends, turns
from pico.diagnosis.darkness import stopped
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Quantity
from pico.diagnosis.responses import Response, between, constant, denser, linear, shown, smooth

FOCAL = (25, 30, 35, 40, 50, 60, 75, 100, 125, 150, 175, 200, 250, 300, 400, 500, 750, 1000)
"""Focal lengths in which lenses come [mm]: where another lens is put into a mount, it has one of these."""
SHARE, FURTHEST = 0.1, 1.1
"""Logarithms of a factor of a focal length: of one that is traced besides, either way, and of the greatest."""
OPENINGS = (0.04, 0.12, 0.25, 0.45, 0.65, 0.85, 0.97)
"""Shares of its opening by which an iris may have closed that are traced."""


@dataclass(frozen=True, eq=False)
class Modelled:
    """Quantities (n) of a bench as the model has them. `lowest`: the least change of each that its instrument can show,
    -inf where there is no such limit."""

    nominal: Nominal
    wanted: tuple[Quantity, ...]
    lowest: Any
    _values: dict[Any, float] = field(default_factory=dict)

    def read(self, steps: Sequence[Step] = (), *, scans: bool = True) -> Any:
        """Return the quantities (n,) after some changes, nan where the model does not tell, or of `scans` that are left
        out."""
        return np.array([self._value(one, steps) if scans or not one.tunable else math.nan for one in self.wanted])

    def _value(self, one: Quantity, steps: Sequence[Step]) -> float:
        """Return a quantity after some changes; what was asked once is kept."""
        key = (id(one), tuple(s for s in steps if any(self.nominal.matters(shot, s.part) for shot in one.shots)))
        if key not in self._values:
            found = self.nominal.quantity(one, steps)
            self._values[key] = math.nan if found is None else found.value
        return self._values[key]

    @property
    def asked(self) -> int:
        """How many values of quantities were asked of the ray model."""
        return len(self._values)

    def only(self, numbers: Sequence[int]) -> Modelled:
        """Return the same for some of the quantities, with what was asked of these."""
        return Modelled(self.nominal, tuple(self.wanted[n] for n in numbers), self.lowest[numbers], self._values)

    @cached_property
    def base(self) -> Any:
        """The quantities (n,) without any change."""
        return self.read()

    def changes(self, steps: Sequence[Step]) -> Any:
        """Return by how much quantities (n,) change, nan where the model does not tell; where no light comes any more,
        by as much as can be shown."""
        return self.shown(self.read(steps) - self.base)

    def shown(self, changes: Any) -> Any:
        """Return changes (..., n) as instruments show them."""
        return shown(changes, self.lowest)

    def slopes(self, ways: Sequence[tuple[str, Way]]) -> dict[tuple[str, str], Any]:
        """Return the derivatives (n,) of the quantities by ways of parts, 0 where the model does not tell."""
        return {(part, way.what): self._slope(part, way) for part, way in ways}

    def _slope(self, part: str, way: Way) -> Any:
        slope = (self.read((Step(part, way.what, way.step),)) - self.base) / way.step
        return np.where(np.isfinite(slope) & (np.abs(slope) * way.fault > 1e-9), slope, 0.0)

    def proportional(self, possible: Sequence[Cause]) -> tuple[Response, ...]:
        """Return what each cause does, taken to be in proportion to its size: with one trace for each way."""
        slopes = self.nominal.kept("slopes", (repr(self.wanted), tuple(possible)), partial(self._slopes, possible))
        return tuple(linear(c, [slopes[c.part, w.what] for w in c.ways]) for c in possible if c.ways)

    def _slopes(self, possible: Sequence[Cause]) -> dict[tuple[str, str], Any]:
        return self.slopes([(cause.part, way) for cause in possible for way in cause.ways])

    def responses(self, possible: Sequence[Cause]) -> tuple[Response, ...]:
        """Return what each cause does to the quantities, by its size; what was traced once is kept."""
        key = repr(self.wanted)
        return tuple(self.nominal.kept("response", (key, c), partial(self._response, c)) for c in possible)

    def _response(self, cause: Cause) -> Response:
        if not cause.ways:
            return constant(cause, stopped(self.nominal, self.wanted, cause))
        if len(cause.ways) == 1 and (sizes := self._traced(cause.part, cause.ways[0])):
            return self._tabled(cause, sizes)
        steps = [w.step for w in cause.ways]
        return smooth(cause, steps, lambda at, scans: self.read(self._steps(cause, at), scans=scans) - self.base)

    def _traced(self, part: str, way: Way) -> tuple[float, ...]:
        """Return the sizes of a way that are traced, where no parabola tells what it does; none where one does."""
        if way.what == "focal":
            own = self.nominal.setup.type_of(part).number("focal_length", "mm") or FOCAL[0]
            others = [math.log(f / abs(own)) for f in FOCAL]
            return tuple(sorted({-SHARE, SHARE, *(s for s in others if SHARE < abs(s) < FURTHEST)}))
        if way.what.endswith(":opening"):
            live = float(self.nominal.values.get(part, {}).get("opening") or 0.0)
            return (*(-s * live for s in reversed(OPENINGS)), 0.1 * live, 0.4 * live) if live else ()
        return (math.inf,) if bends(way) else ()

    def _tabled(self, cause: Cause, sizes: tuple[float, ...]) -> Response:
        (way,) = cause.ways
        if sizes[0] < math.inf:
            rows = {s: self.read(self._steps(cause, (s,))) - self.base for s in sizes}
            return between(cause, denser({0.0: np.zeros(len(self.wanted)), **rows}))
        curve = Curve(self.nominal, cause.part, way)
        rows = {float(s): curve.quantities(self.wanted, float(s)) - self.base for s in curve.sizes}
        if turns(way):
            far = Curve(self.nominal, cause.part, way, whole=True)
            rows |= {float(s): far.quantities(self.wanted, float(s)) - self.base for s in far.sizes}
        return between(cause, rows)

    def _steps(self, cause: Cause, size: Sequence[float]) -> tuple[Step, ...]:
        return tuple(Step(cause.part, w.what, float(s)) for w, s in zip(cause.ways, size, strict=True) if s)
